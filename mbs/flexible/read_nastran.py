"""Models written by Nastran: matrices in OUTPUT4 or DMIG, nodes in the bulk data (reader: pyNastran, extra `fem`)."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import scipy.sparse as sp

from mbs.errors import ModelError
from mbs.flexible.external_model import external_model
from mbs.flexible.fe_model import FiniteElementModel
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
    """
    try:
        from pyNastran.bdf.bdf import read_bdf
        from pyNastran.op4.op4 import read_op4
    except ImportError as error:
        raise ModelError("Nastran files are read with pyNastran: install it with pip install 'ali3[fem]'.") from error
    for path in (bulk_data, matrices):
        if not Path(path).is_file():
            raise ModelError(f"There is no file {path}.")
    deck = read_bdf(str(bulk_data), xref=True, punch=_is_punch(bulk_data), validate=False, debug=None)
    numbers = sorted(deck.nodes)
    for number in numbers:
        if deck.nodes[number].Cd() != 0:
            raise ModelError(f"Grid point {number} has displacements in a system of its own; use the basic system.")
    positions = np.array([deck.nodes[number].get_position() for number in numbers])
    found = read_op4(str(matrices), debug=None)
    for name in (stiffness, mass):
        if name not in found:
            raise ModelError(f"{Path(matrices).name} has no matrix {name}; it has {', '.join(sorted(found))}.")
    K, M = (_symmetric(found[name].data) for name in (stiffness, mass))
    return external_model(K, M, positions, [str(number) for number in numbers])


def _is_punch(path: str | Path) -> bool:
    """Whether a deck has bulk data only, without executive and case control."""
    lines = Path(path).read_text(encoding="latin-1").upper().splitlines()
    return not any(line.strip().startswith("CEND") for line in lines)


def _symmetric(data: np.ndarray | Sparse) -> sp.csc_array:
    """Whole matrix from what may be one triangle of it."""
    full = sp.csc_array(data)
    lower, upper = sp.tril(full, -1), sp.triu(full, 1)
    if lower.nnz and upper.nnz:
        return full
    return sp.csc_array(full + (lower + upper).T)
