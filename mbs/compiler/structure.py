"""Counts, rank and degrees of freedom, non-zeros of a System."""

from typing import Any

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from mbs.compiler.fronts import Fronts
from mbs.model.model import Model

RANK_TOLERANCE = 1e-7
"""Singular values of the mass-normalised rows below this part of the largest count as zero."""
DENSE_RANK = 300
"""Up to this many rows the rank comes from singular values, above from the inertia of a sparse factorization."""


def rank_at(Phiq: sparse.csr_matrix, mass_diagonal: np.ndarray) -> int | None:
    """Rank of Phi_q at the reference position; None if it could not be computed.

    Large systems: Phi_q M^-1 Phi_q' - sigma has as many negative pivots as eigenvalues below sigma (Sylvester).
    """
    nc = Phiq.shape[0]
    if nc == 0:
        return 0
    mean = float(np.mean(mass_diagonal[mass_diagonal > 0.0])) if np.any(mass_diagonal > 0.0) else 1.0
    D = 1.0 / np.sqrt(np.where(mass_diagonal > 0.0, mass_diagonal, mean))
    J = Phiq @ sparse.diags(D)
    size = np.sqrt(np.asarray(J.multiply(J).sum(axis=1)).ravel())
    J = sparse.diags(1.0 / np.where(size > 0.0, size, 1.0)) @ J
    if nc <= DENSE_RANK:
        values = np.linalg.svd(J.toarray(), compute_uv=False)
        return int(np.sum(values > RANK_TOLERANCE * values[0])) if values.size and values[0] > 0.0 else 0
    shifted = (J @ J.T - RANK_TOLERANCE * sparse.identity(nc)).tocsc()
    try:
        factor = splu(shifted, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    except RuntimeError:
        return None
    if not np.array_equal(factor.perm_r, factor.perm_c):
        return None  # rows were exchanged: the signs of the pivots no longer count eigenvalues
    return nc - int(np.sum(factor.U.diagonal() < 0.0))


def structure_report(model: Model, fronts: Fronts, rank: int | None, rows: int) -> dict[str, Any]:
    """Counts of the System and its factor."""
    return {
        "bodies": len(model.bodies),
        "full_coordinates": len(model.coordinates),
        "coordinates": len(fronts.order),
        "rows": rows,
        "rank": rank,
        "degrees_of_freedom": None if rank is None else len(fronts.order) - rank,
        "factor_nonzeros": fronts.factor_nonzeros,
        "fronts": len(fronts.index),
        "largest_front": max(len(i) for i in fronts.index),
        "elements": len(model.elements),
        "inputs": len(model.inputs),
        "sensors": len(model.sensors),
    }
