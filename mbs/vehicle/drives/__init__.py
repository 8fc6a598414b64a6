"""Templates of drives: a new one is a file here and a member of `Drive`."""

from typing import Annotated

from pydantic import Field

from mbs.vehicle.drives.automatic import Automatic
from mbs.vehicle.drives.electric import Electric

Drive = Annotated[Automatic | Electric, Field(discriminator="kind")]

__all__ = ["Drive"]
