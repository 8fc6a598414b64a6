"""Coordinates that a run records for its poses: at all samples, or at every n-th so that memory is bounded."""

import numpy as np
from numpy.typing import NDArray

from mbs.results.poses import Poses, pose_interval
from mbs.system.system import System

Array = NDArray[np.float64]


class PositionRecord:
    """Coordinates of a run; none if its System has no drawing.

    Parameters
    ----------
    system : System
        The System of the run.
    q : array of shape (nq,)
        Coordinates at the first sample.
    samples : int
        Number of samples, with the first one.
    every : int
        Largest density: one of `every` samples.
    """

    def __init__(self, system: System, q: Array, samples: int, every: int = 1) -> None:
        self.drawing, nq = system.drawing, system.nq
        self.every = pose_interval(samples, nq, every)
        self._q = np.empty(((samples - 1) // self.every + 1, nq)) if self.drawing is not None else None
        if self._q is not None:
            self._q[0] = q

    def rows(self, first: int, count: int) -> Array | None:
        """Array (count, nq) to which the kernel writes the samples beginning with `first`; None: not needed."""
        if self._q is None:
            return None
        return self._q[first : first + count] if self.every == 1 else np.empty((count, self._q.shape[1]))

    def store(self, first: int, rows: Array | None) -> None:
        """Store the samples, beginning with `first`, that were written to `rows`, the array of the method `rows`."""
        if self._q is None or rows is None or self.every == 1:
            return
        begin = -first % self.every
        samples = rows[begin :: self.every]
        row = (first + begin) // self.every
        self._q[row : row + len(samples)] = samples

    def fill(self, positions: Array) -> None:
        """Store all samples at once, shape (samples, nq)."""
        if self._q is not None:
            self._q[:] = positions[:: self.every]

    def poses(self, t: Array) -> Poses | None:
        """Poses of the samples at the times `t` (n,)."""
        if self.drawing is None or self._q is None:
            return None
        times = t[:: self.every]
        return Poses(times, self.every, self._q[: len(times)], self.drawing.places)
