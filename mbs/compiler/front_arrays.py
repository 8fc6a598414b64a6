"""Fronts as arrays of the System file, and positions of rows, elements and mass in them."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from mbs.compiler.fronts import Fronts
from mbs.compiler.row_arrays import RowArrays

Index = NDArray[np.int64]
Locate = Callable[[Sequence[int]], tuple[int, list[int]]]


def locator(fronts: Fronts) -> Locate:
    """A function from coordinates to the number of their front and their indices in it."""
    front_of = np.repeat(np.arange(len(fronts.index)), np.diff(fronts.col))

    def locate(columns: Sequence[int]) -> tuple[int, list[int]]:
        s = int(front_of[min(columns)])
        local = np.searchsorted(fronts.index[s], columns)
        assert np.array_equal(fronts.index[s][local], columns), "a clique lies outside its front"
        return s, [int(i) for i in local]

    return locate


def row_fronts(arrays: RowArrays, locate: Locate) -> dict[str, Any]:
    """The arrays `row_front` and `row_loc`."""
    fronts, local = [], []
    for columns in arrays.cliques():
        s, indices = locate(columns.tolist())
        fronts.append(s)
        local += indices
    return {"row_front": np.array(fronts, dtype=np.int64), "row_loc": np.array(local, dtype=np.int64)}


def front_arrays(fronts: Fronts) -> dict[str, Any]:
    """Arrays `front_` of a System: fronts of the elimination, and where their borders lie in the front above."""
    sizes = np.array([len(i) for i in fronts.index], dtype=np.int64)
    maps = []
    for s, index in enumerate(fronts.index):
        pivots = int(fronts.col[s + 1] - fronts.col[s])
        border = index[pivots:]
        maps.append(np.full(pivots, -1))
        if len(border):
            maps.append(np.searchsorted(fronts.index[fronts.parent[s]], border))
    return {
        "front_col": fronts.col,
        "front_ptr": np.concatenate([[0], np.cumsum(sizes)]),
        "front_idx": np.concatenate(fronts.index),
        "front_parent": fronts.parent,
        "front_map": np.concatenate(maps),
        "front_off": np.concatenate([[0], np.cumsum(sizes * sizes)]),
    }


def mass_positions(mass: sparse.csr_matrix, fronts: Fronts) -> Index:
    """Position of each entry of the lower triangle in front storage; -1 above the diagonal."""
    sizes = np.array([len(i) for i in fronts.index], dtype=np.int64)
    offset = np.concatenate([[0], np.cumsum(sizes * sizes)])
    front_of = np.repeat(np.arange(len(fronts.index)), np.diff(fronts.col))
    row = np.repeat(np.arange(mass.shape[0]), np.diff(mass.indptr))
    positions = np.full(mass.nnz, -1, dtype=np.int64)
    for n in np.flatnonzero(row >= mass.indices):
        j = int(mass.indices[n])
        s = int(front_of[j])
        i_local = int(np.searchsorted(fronts.index[s], row[n]))
        positions[n] = offset[s] + (j - fronts.col[s]) * sizes[s] + i_local
    return positions
