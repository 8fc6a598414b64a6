"""A frame from CalculiX."""

from pathlib import Path
from typing import Literal

from mbs.flexible.calculix import read_calculix
from mbs.flexible.fe_model import FiniteElementModel
from mbs.vehicle.chassis.frames.matrix_frame import MatrixFrame
from mbs.vehicle.files import car_file_path


class CalculixFrame(MatrixFrame):
    """Frame of solid elements from CalculiX, by ``*FREQUENCY, SOLVER=MATRIXSTORAGE`` (`read_calculix`)."""

    kind: Literal["calculix"]
    """Names this template."""
    deck: str
    """Input deck, name.inp; name.sti, name.mas and name.dof lie beside it."""

    def files(self, folder: Path) -> tuple[Path, ...]:
        """Files of the matrices, all of which exist."""
        return (car_file_path(folder, self.deck, self.key("deck")),)

    def finite_elements(self, folder: Path) -> FiniteElementModel:
        """Read the deck, which must have no supports, and its matrices."""
        return read_calculix(*self.files(folder))
