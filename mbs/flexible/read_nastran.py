"""Models written by Nastran: matrices in OUTPUT4, grid points in the bulk data (reader: pyYeti, extra `fem`)."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import scipy.sparse as sp

from ali3.extras import missing_module
from mbs.common.errors import ModelError
from mbs.flexible.external_model import external_model
from mbs.flexible.fe_model import FiniteElementModel
from mbs.flexible.foreign_file import read_foreign
from mbs.flexible.sparse import Sparse


def read_nastran(
    bulk_data: str | Path, matrices: str | Path, stiffness: str = "KGG", mass: str = "MGG"
) -> FiniteElementModel:
    """Model from a bulk data file with the grid points and an OUTPUT4 file with the g-set matrices.

    The g-set has six freedoms per grid point, grid points in ascending order. Grid points and displacements must be
    in the basic coordinate system, in SI units.

    Parameters
    ----------
    bulk_data : str or Path
        ``.bdf``, ``.dat``, ``.nas``.
    matrices : str or Path
        ``.op4``, text or binary.
    stiffness, mass : str
        Names of the matrices in the file.

    Returns
    -------
    FiniteElementModel
        Nodes are named by the numbers of their grid points.

    Raises
    ------
    ModelError
        pyYeti is not installed, a file or a matrix is missing, or a grid point has axes of its own.
    """
    try:
        from pyyeti.nastran import bulk, op4
    except ModuleNotFoundError as error:
        raise ModelError(f"Nastran files are read with pyYeti. {missing_module(error, 'fem')}") from error
    for path in (bulk_data, matrices):
        if not Path(path).is_file():
            raise ModelError(f"There is no file {path}.")
    cards = read_foreign(Path(bulk_data), lambda path: bulk.rdgrids(str(path)))
    if cards is None:
        raise ModelError(f"{bulk_data} holds no grid points.")
    for number, own in cards[:, (0, 5)]:
        if own != 0:
            raise ModelError(f"Grid point {number:.0f} has displacements in a system of its own; use the basic system.")
    # one row per freedom, the first of six: grid point, freedom, set, place in the basic system
    table = read_foreign(Path(bulk_data), lambda path: bulk.bulk2uset(str(path))[0])
    points = table.reset_index().to_numpy(float)[::6]
    points = points[np.argsort(points[:, 0])]
    numbers, positions = points[:, 0].astype(int), points[:, 3:6]
    read = read_foreign(Path(matrices), lambda path: op4.read(str(path), sparse=True))
    found = {name.upper(): matrix for name, matrix in read.items()}
    for name in (stiffness, mass):
        if name.upper() not in found:
            raise ModelError(f"{Path(matrices).name} has no matrix {name}; it has {', '.join(sorted(found))}.")
    K, M = (_symmetric(found[name.upper()]) for name in (stiffness, mass))
    return external_model(K, M, positions, [str(number) for number in numbers])


def _symmetric(data: np.ndarray | Sparse) -> sp.csc_array:
    """Whole matrix from what may be one triangle of it."""
    full = sp.csc_array(data)
    lower, upper = sp.tril(full, -1), sp.triu(full, 1)
    if lower.nnz and upper.nnz:
        return full
    return sp.csc_array(full + (lower + upper).T)
