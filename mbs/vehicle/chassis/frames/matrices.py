"""A frame from matrices in plain files."""

from pathlib import Path
from typing import Literal

from mbs.common.errors import ModelError
from mbs.flexible.fe_model import FiniteElementModel
from mbs.flexible.matrix_files import external_model, read_matrix
from mbs.flexible.sparse_matrices import Sparse
from mbs.vehicle.chassis.frames.matrix_frame import MatrixFrame
from mbs.vehicle.files import car_file_path
from mbs.vehicle.table import read_table

MAX_COORDINATE = 1e3  # m


class MatricesFrame(MatrixFrame):
    """Frame from matrices as Matrix Market or SciPy files; per node the freedoms x, y, z, and rx, ry, rz if there."""

    kind: Literal["matrices"]
    """Names this template."""
    stiffness: str
    """Stiffness matrix: .mtx, .mtx.gz or .npz."""
    mass: str
    """Mass matrix, as `stiffness`."""
    nodes: str
    """Table of the nodes in the order of the matrices: name, x, y, z."""

    def files(self, folder: Path) -> tuple[Path, ...]:
        """Files of the matrices, all of which exist."""
        return tuple(car_file_path(folder, getattr(self, f), self.key(f)) for f in ("stiffness", "mass", "nodes"))

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
