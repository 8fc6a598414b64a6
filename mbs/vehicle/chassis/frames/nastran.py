"""A frame from Nastran."""

from pathlib import Path
from typing import Literal

from mbs.flexible.fe_model import FiniteElementModel
from mbs.flexible.nastran import read_nastran
from mbs.vehicle.chassis.frames.matrix_frame import MatrixFrame
from mbs.vehicle.files import car_file_path


class NastranFrame(MatrixFrame):
    """Frame from Nastran's matrices of the g-set (`read_nastran`)."""

    kind: Literal["nastran"]
    """Names this template."""
    bulk_data: str
    """File with the grid points: .bdf, .dat or .nas."""
    matrices: str
    """OUTPUT4 file with the matrices: .op4."""
    stiffness: str = "KGG"
    """Name of the stiffness matrix in it."""
    mass: str = "MGG"
    """Name of the mass matrix in it."""

    def files(self, folder: Path) -> tuple[Path, ...]:
        """Files of the matrices, all of which exist."""
        return tuple(car_file_path(folder, getattr(self, f), self.key(f)) for f in ("bulk_data", "matrices"))

    def finite_elements(self, folder: Path) -> FiniteElementModel:
        """Read grid points, which must have no axes of their own, and matrices."""
        bulk_data, matrices = self.files(folder)
        return read_nastran(bulk_data, matrices, self.stiffness, self.mass)
