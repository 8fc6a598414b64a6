"""Symbolic factorization: elimination tree and fronts (supernodes) of the tangent."""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

Index = NDArray[np.int64]

DENSE_SIZE = 24
"""Systems up to this many coordinates are one dense front."""
MERGE_SIZE = 12
"""A child is merged into its parent if the merged front has at most this many coordinates."""
MERGE_SIZE_FLEXIBLE = 44
"""The same for models with flexible bodies, whose modes are long columns of one front."""
MERGE_ZEROS = 0.25
"""A child is also merged if at most this part of the merged trapezoid are new zeros."""


@dataclass(frozen=True)
class Fronts:
    """Fronts of a symmetric matrix in elimination order."""

    order: Index
    """Shape (n,): entry k is the coordinate that is eliminated k-th, in the numbers of the model; all other arrays use
    the numbers of this order."""
    col: Index
    """Shape (nf + 1,): front s eliminates col[s] .. col[s+1]-1."""
    index: list[Index]
    """Coordinates of each front, ascending, pivots first."""
    parent: Index
    """Shape (nf,): parent front or -1."""

    @property
    def factor_nonzeros(self) -> int:
        """Stored entries of the factor, lower triangle with diagonal."""
        return sum(_trapezoid(int(p), len(i)) for p, i in zip(np.diff(self.col), self.index, strict=True))


def _trapezoid(pivots: int, size: int) -> int:
    """Number of entries of the factor in a front: its columns of pivots from the diagonal down."""
    return pivots * size - pivots * (pivots - 1) // 2


def build_fronts(pattern: sparse.csc_matrix, order: Index, late: Mapping[int, int] = MappingProxyType({})) -> Fronts:
    """Fronts of a symmetric pattern for an elimination order.

    The pivots of a front are in the order of the model, but those in `late` come last, sorted by its numbers.
    """
    n = pattern.shape[0]
    if n == 0:
        return Fronts(np.zeros(0, int), np.zeros(1, int), [], np.zeros(0, int))
    if n <= DENSE_SIZE:
        return Fronts(np.asarray(order), np.array([0, n]), [np.arange(n)], np.array([-1]))
    structure = _factor_columns(pattern, order)
    parent = [min(s) if s else -1 for s in structure]
    pivots, parent_of = _merge(structure, parent, MERGE_SIZE_FLEXIBLE if late else MERGE_SIZE)
    rank = {k: (late.get(c, 0), c) for k, c in enumerate(map(int, order))}
    groups = {k: sorted(front, key=rank.__getitem__) for k, front in pivots.items()}
    return _number_fronts(np.asarray(order), structure, groups, parent_of)


def _factor_columns(pattern: sparse.csc_matrix, order: Index) -> list[set[int]]:
    """Row structure of each factor column below the diagonal, in the new order."""
    n = len(order)
    new = np.empty(n, dtype=np.int64)
    new[order] = np.arange(n)
    indptr, indices = pattern.indptr, pattern.indices
    structure: list[set[int]] = []
    children: list[list[int]] = [[] for _ in range(n)]
    for k in range(n):
        old = order[k]
        below = {int(i) for i in new[indices[indptr[old] : indptr[old + 1]]] if i > k}
        for child in children[k]:
            below |= structure[child]
        below.discard(k)
        structure.append(below)
        if below:
            children[min(below)].append(k)
    return structure


def _merge(structure: list[set[int]], parent: list[int], size: int) -> tuple[dict[int, list[int]], dict[int, int]]:
    """Merge columns into fronts, children before parents; fronts of up to `size` coordinates are always merged.

    Returns the pivots of each front by its last pivot, and the parent front (by its last pivot, or -1).
    """
    n = len(structure)
    head = list(range(n))  # column -> last pivot of its front; followed by find()
    pivots = {k: [k] for k in range(n)}

    def find(k: int) -> int:
        while head[k] != k:
            head[k] = head[head[k]]
            k = head[k]
        return k

    # zeros in each front, counted again in later merges
    zeros = [0] * n
    for k in range(n):
        p = parent[k]
        if p < 0:
            continue
        top = find(p)
        child = pivots[k]
        child_size, merged_size = len(structure[k]) + len(child), len(pivots[top]) + len(structure[top]) + len(child)
        area = _trapezoid(len(child) + len(pivots[top]), merged_size)
        unmerged_area = _trapezoid(len(child), child_size) + _trapezoid(len(pivots[top]), merged_size - len(child))
        new_zeros = area - unmerged_area + zeros[k] + zeros[top]
        if merged_size <= size or new_zeros <= MERGE_ZEROS * area:
            pivots[top] = child + pivots[top]
            zeros[top] = new_zeros
            head[k] = top
            del pivots[k]
    return pivots, {k: (find(parent[k]) if parent[k] >= 0 else -1) for k in pivots}


def _number_fronts(
    order: Index, structure: list[set[int]], pivots: dict[int, list[int]], parent_of: dict[int, int]
) -> Fronts:
    """Fronts numbered in postorder, with contiguous pivots."""
    children: dict[int, list[int]] = {k: [] for k in pivots}
    roots = []
    for k in sorted(pivots):
        if parent_of[k] >= 0:
            children[parent_of[k]].append(k)
        else:
            roots.append(k)
    postorder: list[int] = []
    stack = list(reversed(roots))
    while stack:  # parents before children, reversed below
        k = stack.pop()
        postorder.append(k)
        stack.extend(children[k])
    postorder.reverse()
    front_of = {k: s for s, k in enumerate(postorder)}
    sequence = [c for k in postorder for c in pivots[k]]
    new = np.empty(len(order), dtype=np.int64)
    new[sequence] = np.arange(len(order))
    col = np.concatenate([[0], np.cumsum([len(pivots[k]) for k in postorder])]).astype(np.int64)
    index = [np.sort(new[[*pivots[k], *structure[k]]]) for k in postorder]
    parents = np.array([front_of[parent_of[k]] if parent_of[k] >= 0 else -1 for k in postorder], dtype=np.int64)
    return Fronts(order[sequence], col, index, parents)
