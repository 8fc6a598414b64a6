"""Random points of the unit cube, a block at a time, so that a million of them need no memory."""

from __future__ import annotations

import warnings

import numpy as np
from numpy.typing import NDArray
from scipy.stats import qmc


class LatinHypercube:
    """A Latin hypercube; its permutations need all points, 8 bytes each per dimension."""

    def __init__(self, dimensions: int, count: int, seed: int) -> None:
        self.count = count
        self._points = qmc.LatinHypercube(dimensions, rng=seed).random(count)

    def block(self, first: int, count: int) -> NDArray[np.float64]:
        """See `Sampler`."""
        return np.asarray(self._points[first : first + count])


class SobolSequence:
    """Sobol' points, scrambled by the seed; good at powers of two."""

    def __init__(self, dimensions: int, count: int, seed: int) -> None:
        self.count = count
        self._engine = qmc.Sobol(dimensions, rng=seed)
        self._next = 0

    def block(self, first: int, count: int) -> NDArray[np.float64]:
        """See `Sampler`; blocks in order are the cheap ones."""
        if first < self._next:
            self._engine.reset()
            self._next = 0
        if first > self._next:
            self._engine.fast_forward(first - self._next)
        with warnings.catch_warnings():
            # The number of all points is what counts, not that of a block; the plan tells of it.
            warnings.filterwarnings("ignore", "The balance properties", UserWarning)
            points = self._engine.random(count)
        self._next = first + count
        return np.asarray(points)


class Saltelli:
    """Points for Sobol' indices, in the order of `SALib.sample.sobol.sample`.

    For each base point come A, A with one coordinate of B for each dimension, and B [Saltelli et al., Comput. Phys.
    Commun. 181 (2010) 259, table 2].
    """

    def __init__(self, dimensions: int, base: int, seed: int) -> None:
        self._dimensions, self._group = dimensions, dimensions + 2
        self.count = base * self._group
        self._base = SobolSequence(2 * dimensions, base, seed)

    def block(self, first: int, count: int) -> NDArray[np.float64]:
        """See `Sampler`."""
        start, stop = first // self._group, -(-(first + count) // self._group)
        pairs, d = self._base.block(start, stop - start), self._dimensions
        a, b = pairs[:, :d], pairs[:, d:]
        points = np.empty((stop - start, self._group, d))
        points[:], points[:, -1] = a[:, None], b
        for k in range(d):
            points[:, 1 + k, k] = b[:, k]
        offset = first - start * self._group
        return points.reshape(-1, d)[offset : offset + count]
