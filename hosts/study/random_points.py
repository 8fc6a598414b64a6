"""Random points of the unit cube, in blocks to save memory."""

import warnings
from collections.abc import Callable
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray
from scipy.stats import qmc

UnitPoints: TypeAlias = Callable[[int, int], NDArray[np.float64]]
"""Function of the number of the first point and a count; returns points in [0, 1), shape (count, dimensions)."""


def latin_hypercube(dimensions: int, count: int, seed: int) -> UnitPoints:
    """A Latin hypercube; all points are in memory, since its permutations depend on their number."""
    points = np.asarray(qmc.LatinHypercube(dimensions, rng=seed).random(count))
    return lambda first, size: points[first : first + size]


def sobol_sequence(dimensions: int, seed: int) -> UnitPoints:
    """Scrambled Sobol' points, balanced at powers of two; blocks in ascending order are fastest."""
    sequence = qmc.Sobol(dimensions, rng=seed)

    def block(first: int, size: int) -> NDArray[np.float64]:
        if first < sequence.num_generated:
            sequence.reset()
        if first > sequence.num_generated:
            sequence.fast_forward(first - sequence.num_generated)
        with warnings.catch_warnings():
            # The balance depends on the number of all points, which the plan checks.
            warnings.filterwarnings("ignore", "The balance properties", UserWarning)
            return np.asarray(sequence.random(size))

    return block


def saltelli(dimensions: int, seed: int) -> UnitPoints:
    """Points for Sobol' indices, in the order of `SALib.sample.sobol.sample`.

    For each base point come A, A with one coordinate of B for each dimension, and B [Saltelli et al., Comput. Phys.
    Commun. 181 (2010) 259, table 2].
    """
    sequence, group = sobol_sequence(2 * dimensions, seed), dimensions + 2

    def block(first: int, size: int) -> NDArray[np.float64]:
        start, stop = first // group, -(-(first + size) // group)
        a, b = np.split(sequence(start, stop - start), 2, axis=1)
        points = np.repeat(a[:, None], group, axis=1)
        points[:, -1] = b
        for k in range(dimensions):
            points[:, 1 + k, k] = b[:, k]
        offset = first - start * group
        return points.reshape(-1, dimensions)[offset : offset + size]

    return block
