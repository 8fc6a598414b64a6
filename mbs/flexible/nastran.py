"""Models written by Nastran: matrices in OUTPUT4, grid points in the bulk data."""

from functools import partial
from pathlib import Path

import numpy as np
import scipy.sparse as sp

from ali3.reading import is_file, missing_file_text
from mbs.common.errors import ModelError
from mbs.flexible.bulk_data import grid_points
from mbs.flexible.fe_model import FiniteElementModel
from mbs.flexible.foreign_file import read_foreign
from mbs.flexible.matrix_files import external_model
from mbs.flexible.output4 import read_output4
from mbs.flexible.sparse_matrices import Sparse


def read_nastran(
    bulk_data: str | Path,
    matrices: str | Path,
    stiffness: str = "KGG",
    mass: str = "MGG",
    folder: str | Path | None = None,
    total_mass: float | None = None,
) -> FiniteElementModel:
    """Model from a bulk data file with the grid points and an OUTPUT4 file with the g-set matrices.

    The g-set has six freedoms per grid point, grid points in ascending order. Displacements must be in the basic
    coordinate system, in SI units; positions may be in any system of a card CORD2R, CORD2C or CORD2S.

    Parameters
    ----------
    bulk_data : str or Path
        ``.bdf``, ``.dat``, ``.nas``.
    matrices : str or Path
        ``.op4``, text or binary.
    stiffness, mass : str
        Names of the matrices in the file.
    folder : str or Path, optional
        Below which the files that the bulk data include lie; by default their own.
    total_mass : float, optional
        As in `external_model`.

    Returns
    -------
    FiniteElementModel
        Nodes are named by the numbers of their grid points; checked, with a `summary`, as by `external_model`.

    Raises
    ------
    ModelError
        A file or a matrix is missing or damaged, a matrix is complex, or a grid point has axes of its own.
    """
    for path in (bulk_data, matrices):
        if not is_file(path):
            raise ModelError(missing_file_text(path))
    points = read_foreign(Path(bulk_data), partial(grid_points, folder=folder))
    for number, (_, system) in points.items():
        if system != 0:
            raise ModelError(f"Grid point {number} has displacements in a system of its own; use the basic system.")
    matrix_of = read_foreign(Path(matrices), read_output4)
    for name in (stiffness, mass):
        if name.upper() not in matrix_of:
            raise ModelError(f"{Path(matrices).name} has no matrix {name}; it has {', '.join(sorted(matrix_of))}.")
        if np.iscomplexobj(matrix_of[name.upper()]):
            raise ModelError(f"The matrix {name} of {Path(matrices).name} is complex; give a real one.")
    K, M = (_symmetric(matrix_of[name.upper()]) for name in (stiffness, mass))
    positions, names = np.array([position for position, _ in points.values()]), [str(number) for number in points]
    return external_model(K, M, positions, names, total_mass=total_mass, what=Path(matrices).name)


def _symmetric(data: Sparse) -> sp.csc_array:
    """Full symmetric matrix from a full matrix or one of its triangles."""
    full = sp.csc_array(data)
    lower, upper = sp.tril(full, -1), sp.triu(full, 1)
    if lower.nnz and upper.nnz:
        return full
    return sp.csc_array(full + (lower + upper).T)
