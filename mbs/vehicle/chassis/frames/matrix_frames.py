"""Frames given as matrices of another program: CalculiX, Nastran, or plain files."""

from abc import abstractmethod
from pathlib import Path
from typing import ClassVar, Literal

from pydantic import Field

from mbs.common.errors import ModelError
from mbs.flexible.calculix import read_calculix
from mbs.flexible.fe_model import FiniteElementModel
from mbs.flexible.matrix_files import external_model, read_matrix
from mbs.flexible.nastran import read_nastran
from mbs.flexible.sparse_matrices import Sparse
from mbs.vehicle.car_files import car_file_path
from mbs.vehicle.chassis.frames.frame_section import FrameSection, Structure
from mbs.vehicle.chassis.gauges.matrix_gauges import MatrixGauge
from mbs.vehicle.chassis.gauges.reading import sort_readings
from mbs.vehicle.names import Name
from mbs.vehicle.table import read_table

MAX_COORDINATE = 1e3  # m


class MatrixFrame(FrameSection):
    """Frame from matrices in SI units, free of supports, in the axes of the drawing; joints are its nodes by name."""

    gauges: dict[Name, MatrixGauge] = Field(default_factory=dict)
    """Strain gauges by name."""

    file_fields: ClassVar[tuple[str, ...]]
    """Fields that name the files of the matrices."""

    def files(self, folder: Path) -> tuple[Path, ...]:
        """Paths of the files in `file_fields`, all of which exist."""
        return tuple(car_file_path(folder, getattr(self, field), self.key(field)) for field in self.file_fields)

    def check(self, folder: Path) -> None:
        """Check that the files exist."""
        self.files(folder)

    @abstractmethod
    def finite_elements(self, folder: Path) -> FiniteElementModel:
        """Read the matrices. Raises `ModelError` if a file is missing, or the body has supports."""

    def structure(self, folder: Path) -> Structure:
        """Read the matrices and the gauges, each of which must be on their nodes."""
        model = self.finite_elements(folder)
        readings = [r for name, gauge in self.gauges.items() for r in gauge.readings(name, model, folder)]
        return Structure(model, sort_readings(readings), dict(zip(model.names, model.positions, strict=True)))


class CalculixFrame(MatrixFrame):
    """Frame of solid elements from CalculiX, by ``*FREQUENCY, SOLVER=MATRIXSTORAGE`` (`read_calculix`)."""

    file_fields: ClassVar[tuple[str, ...]] = ("deck",)

    kind: Literal["calculix"]
    """Names this template."""
    deck: str
    """Input deck, name.inp; name.sti, name.mas and name.dof lie beside it."""

    def finite_elements(self, folder: Path) -> FiniteElementModel:
        """Read the deck, which must have no supports, and its matrices."""
        return read_calculix(*self.files(folder))


class NastranFrame(MatrixFrame):
    """Frame from Nastran's matrices of the g-set (`read_nastran`)."""

    file_fields: ClassVar[tuple[str, ...]] = ("bulk_data", "matrices")

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

    def finite_elements(self, folder: Path) -> FiniteElementModel:
        """Read grid points, which must have no axes of their own, and matrices."""
        bulk_data, matrices = self.files(folder)
        return read_nastran(bulk_data, matrices, self.stiffness, self.mass)


class MatricesFrame(MatrixFrame):
    """Frame from matrices as Matrix Market or SciPy files; per node the freedoms x, y, z, and rx, ry, rz if there."""

    file_fields: ClassVar[tuple[str, ...]] = ("stiffness", "mass", "nodes")

    kind: Literal["matrices"]
    """Names this template."""
    stiffness: str
    """Stiffness matrix: .mtx, .mtx.gz or .npz."""
    mass: str
    """Mass matrix, as `stiffness`."""
    nodes: str
    """Table of the nodes in the order of the matrices: name, x, y, z."""

    def finite_elements(self, folder: Path) -> FiniteElementModel:
        """Read the files."""
        stiffness, mass, _ = self.files(folder)
        rows = read_table(folder, self.nodes, self.key("nodes"), ("name", "x", "y", "z"))
        positions = [[row.number(axis, -MAX_COORDINATE, MAX_COORDINATE, "m") for axis in "xyz"] for row in rows]
        matrices = self._matrix("stiffness", stiffness), self._matrix("mass", mass)
        return external_model(*matrices, positions, [row["name"] for row in rows])

    def _matrix(self, field: str, path: Path) -> Sparse:
        """Read the matrix of a field. Raises `ModelError` if it cannot be read."""
        try:
            return read_matrix(path)
        except ModelError:
            raise
        except Exception as error:  # the errors of SciPy's readers on damaged files have no common class
            raise ModelError(f"{self.key(field)}: {path.name} holds no matrix that can be read: {error}.") from error
