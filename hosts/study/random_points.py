"""Random points of the unit cube, a block at a time, so that a million of them need no memory."""

import warnings
from collections.abc import Callable
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray
from scipy.stats import qmc

Places: TypeAlias = Callable[[int, int], NDArray[np.float64]]
"""Of the number of a point and how many: where they lie in [0, 1), of shape (count, dimensions)."""


def latin_hypercube(dimensions: int, count: int, seed: int) -> Places:
    """A Latin hypercube; its permutations need all points, 8 bytes each per dimension."""
    points = np.asarray(qmc.LatinHypercube(dimensions, rng=seed).random(count))
    return lambda first, size: points[first : first + size]


def sobol_sequence(dimensions: int, seed: int) -> Places:
    """Sobol' points, scrambled by the seed; good at powers of two. Blocks in order are the cheap ones."""
    engine = qmc.Sobol(dimensions, rng=seed)

    def block(first: int, size: int) -> NDArray[np.float64]:
        if first < engine.num_generated:
            engine.reset()
        if first > engine.num_generated:
            engine.fast_forward(first - engine.num_generated)
        with warnings.catch_warnings():
            # The number of all points is what counts, not that of a block; the plan tells of it.
            warnings.filterwarnings("ignore", "The balance properties", UserWarning)
            return np.asarray(engine.random(size))

    return block


def saltelli(dimensions: int, seed: int) -> Places:
    """Points for Sobol' indices, in the order of `SALib.sample.sobol.sample`.

    For each base point come A, A with one coordinate of B for each dimension, and B [Saltelli et al., Comput. Phys.
    Commun. 181 (2010) 259, table 2].
    """
    base, group = sobol_sequence(2 * dimensions, seed), dimensions + 2

    def block(first: int, size: int) -> NDArray[np.float64]:
        start, stop = first // group, -(-(first + size) // group)
        a, b = np.split(base(start, stop - start), 2, axis=1)
        points = np.repeat(a[:, None], group, axis=1)
        points[:, -1] = b
        for k in range(dimensions):
            points[:, 1 + k, k] = b[:, k]
        offset = first - start * group
        return points.reshape(-1, dimensions)[offset : offset + size]

    return block
