"""Scaling of the rows by the mass, so that one penalty suits all."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from mbs.common.errors import ModelError
from mbs.compiler.polynomial import RowTerms

Array = NDArray[np.float64]


def row_scale(
    rows: Sequence[RowTerms], Phiq: sparse.csr_matrix, diagonal: Array, tolerance_factor: float
) -> tuple[Array, Array]:
    """`row_scale` and `row_measure` of the System file, shape (nc,).

    `diagonal`: diagonal of the mass matrix, shape (nq,); `tolerance_factor`: `length_tolerance_factor`.
    Raises `ModelError` if a row has no gradient.
    """
    inverse = np.where(diagonal > 0.0, 1.0 / np.where(diagonal > 0.0, diagonal, 1.0), 0.0)
    squared = Phiq.multiply(Phiq).tocsr()
    by_mass = np.asarray(squared @ inverse).ravel()
    length = np.sqrt(np.asarray(squared.sum(axis=1)).ravel())
    zero_rows = [rows[i] for i in np.flatnonzero(length == 0.0).tolist()]
    if zero_rows:
        names = ", ".join(f"'{r.name}' ({r.kind})" for r in zero_rows)
        raise ModelError(
            f"The condition of {names} does not move with any coordinate at the start; change the drawing there."
        )
    # a row over coordinates without mass, which are angles, is scaled as if they had the mean mass at a lever
    lever = np.where(by_mass > 0.0, 1.0, tolerance_factor)
    by_mass = np.where(
        by_mass > 0.0, by_mass, (length / tolerance_factor) ** 2 / float(np.mean(diagonal[diagonal > 0.0]))
    )
    scale = 1.0 / np.sqrt(by_mass)
    return scale, lever / (length * scale)
