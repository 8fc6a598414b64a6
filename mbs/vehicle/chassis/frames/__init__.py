"""Flexible frames, one file each: a new one is a file here and a line in `Frame`."""

from typing import Annotated

from pydantic import Field

from mbs.vehicle.chassis.frames.calculix import CalculixFrame
from mbs.vehicle.chassis.frames.matrices import MatricesFrame
from mbs.vehicle.chassis.frames.nastran import NastranFrame
from mbs.vehicle.chassis.frames.tubes import TubesFrame

Frame = Annotated[TubesFrame | CalculixFrame | NastranFrame | MatricesFrame, Field(discriminator="kind")]

__all__ = ["Frame"]
