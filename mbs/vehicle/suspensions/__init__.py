"""Templates of suspensions: a new one is a file here and a line in `Suspension`."""

from typing import Annotated

from pydantic import Field

from mbs.vehicle.suspensions.curves import Curves
from mbs.vehicle.suspensions.double_wishbone import DoubleWishbone
from mbs.vehicle.suspensions.lower_arm_strut import LowerArmStrut
from mbs.vehicle.suspensions.macpherson import MacPherson
from mbs.vehicle.suspensions.twist_beam import TwistBeam

Suspension = Annotated[DoubleWishbone | LowerArmStrut | MacPherson | TwistBeam | Curves, Field(discriminator="kind")]

__all__ = ["Suspension"]
