"""Elimination order of the coordinates: fill-reducing, on the pattern of the tangent (23)."""

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.linalg import splu

Index = NDArray[np.int64]


def clique_pattern(n: int, cliques: Iterable[Sequence[int]]) -> sparse.csc_matrix:
    """Symmetric 0/1 pattern with a full diagonal in which every clique is a dense block."""
    blocks = [[k] for k in range(n)] + [list(clique) for clique in cliques]
    members = np.array([k for block in blocks for k in block], dtype=np.int64)
    starts = np.cumsum([0, *map(len, blocks)])
    incidence = sparse.csr_matrix((np.ones(len(members)), members, starts), shape=(len(blocks), n))
    pattern = (incidence.T @ incidence).tocsc()
    pattern.sort_indices()
    pattern.data[:] = 1.0
    return pattern


def fill_reducing_order(pattern: sparse.csc_matrix) -> Index:
    """Minimum-degree order; entry k is the coordinate eliminated k-th.

    SuperLU orders by multiple minimum degree on A' + A; its factorization of a diagonally dominant matrix with the
    same pattern is a by-product.
    """
    n = pattern.shape[0]
    if n < 2:
        return np.arange(n)
    degree = np.asarray(pattern.sum(axis=1)).ravel()
    dominant = sparse.diags(2.0 * degree + 1.0) - pattern
    factor = splu(dominant.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    return np.argsort(factor.perm_c)
