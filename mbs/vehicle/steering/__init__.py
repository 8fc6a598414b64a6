"""Templates of steerings: a new one is a file here and a member of `Steering`."""

from typing import Annotated

from pydantic import Field

from mbs.vehicle.steering.column import Column
from mbs.vehicle.steering.pitman_arm import PitmanArm
from mbs.vehicle.steering.rack_by_angle import RackByAngle

Steering = Annotated[RackByAngle | Column | PitmanArm, Field(discriminator="kind")]

__all__ = ["Steering"]
