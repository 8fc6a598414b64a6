"""Templates of suspensions: a new one is a class here and a line in `Suspension`."""

from typing import Annotated

from pydantic import Field

from mbs.vehicle.suspensions.curves import Curves
from mbs.vehicle.suspensions.double_wishbone import DoubleWishbone
from mbs.vehicle.suspensions.strut import LowerArmStrut, MacPherson
from mbs.vehicle.suspensions.twist_beam import TwistBeam

Suspension = Annotated[DoubleWishbone | LowerArmStrut | MacPherson | TwistBeam | Curves, Field(discriminator="kind")]

__all__ = ["Suspension"]
