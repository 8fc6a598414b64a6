"""Flexible frames: a new one is a class here and a line in `Frame`."""

from typing import Annotated

from pydantic import Field

from mbs.vehicle.chassis.frames.matrix_frames import CalculixFrame, MatricesFrame, NastranFrame
from mbs.vehicle.chassis.frames.tubes import TubesFrame

Frame = Annotated[TubesFrame | CalculixFrame | NastranFrame | MatricesFrame, Field(discriminator="kind")]

__all__ = ["Frame"]
