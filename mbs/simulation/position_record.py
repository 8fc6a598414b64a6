"""Coordinates that a run keeps for its poses: all recorded ones, or one of many, so that memory is bounded."""

import numpy as np
from numpy.typing import NDArray

from mbs.results.poses import Poses, kept_every
from mbs.system.system import System

Array = NDArray[np.float64]


class PositionRecord:
    """Coordinates of a run of `samples` samples.

    Parameters
    ----------
    system : System
        Without a drawing nothing is kept.
    q : array of shape (nq,)
        At the first sample.
    samples : int
        The first one included.
    every : int
        One of that many samples is wanted at most.
    """

    def __init__(self, system: System, q: Array, samples: int, every: int = 1) -> None:
        self.drawing, nq = system.drawing, system.nq
        self.every = kept_every(samples, nq, every)
        self._kept = np.empty(((samples - 1) // self.every + 1, nq)) if self.drawing is not None else None
        if self._kept is not None:
            self._kept[0] = q

    def rows(self, first: int, count: int) -> Array | None:
        """Where the kernel writes samples `first` to ``first + count - 1``, shape (count, nq); None: nowhere."""
        if self._kept is None:
            return None
        return self._kept[first : first + count] if self.every == 1 else np.empty((count, self._kept.shape[1]))

    def take(self, first: int, rows: Array | None) -> None:
        """Keep what was written to `rows`."""
        if self._kept is None or rows is None or self.every == 1:
            return
        begin = -first % self.every
        found = rows[begin :: self.every]
        at = (first + begin) // self.every
        self._kept[at : at + len(found)] = found

    def fill(self, positions: Array) -> None:
        """Keep of all samples at once, shape (samples, nq)."""
        if self._kept is not None:
            self._kept[:] = positions[:: self.every]

    def poses(self, t: Array) -> Poses | None:
        """Poses of the samples at the times `t` (n,)."""
        if self.drawing is None or self._kept is None:
            return None
        own = t[:: self.every]
        return Poses(own, self.every, self._kept[: len(own)], self.drawing.places)
