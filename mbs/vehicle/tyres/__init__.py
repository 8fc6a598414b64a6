"""Tyres of a car file: a new formula is a file here and a member of `Tyre`."""

from typing import Annotated

from pydantic import Field

from mbs.vehicle.tyres.magic_formula import MagicFormula
from mbs.vehicle.tyres.tmeasy import TMeasy

Tyre = Annotated[TMeasy | MagicFormula, Field(discriminator="kind")]

__all__ = ["Tyre"]
