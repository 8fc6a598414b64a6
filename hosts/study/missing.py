"""Runs that are not done yet, in chunks that grow to seconds of work."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

WORK = 2.0  # s of a chunk: Dask takes some milliseconds for a task
_MOST = 5000  # runs of a chunk
_SMOOTHING = 0.3
_LOOK = 100_000  # runs that are looked at a time


class ChunkSize:
    """How many runs make a chunk, from the time they take.

    `seconds`: of a run, as far as is known; `most`: runs of a chunk, by the memory their results need.
    """

    def __init__(self, seconds: float, workers: int, most: int = _MOST) -> None:
        self._seconds, self.workers, self._most = max(seconds, 1e-6), max(1, workers), max(1, min(most, _MOST))

    def learn(self, runs: int, seconds: float) -> None:
        """Take the time of a chunk into account."""
        if runs:
            self._seconds += _SMOOTHING * (max(seconds / runs, 1e-6) - self._seconds)

    def size(self, left: int) -> int:
        """Of the next chunk where so many runs are left; smaller at the end, so that workers end together."""
        return max(1, min(round(WORK / self._seconds), self._most, -(-left // (2 * self.workers))))


def missing_runs(done: NDArray[np.bool_], size: ChunkSize) -> Iterator[list[int]]:
    """Rising indices of runs that are not done, chunk by chunk.

    `done`: shape (runs,); `size`: asked before each chunk.
    """
    left = int(len(done) - np.count_nonzero(done))
    ready: list[int] = []
    place = 0
    while left:
        wanted = size.size(left)
        while len(ready) < wanted and place < len(done):
            ready += (place + np.flatnonzero(~done[place : place + _LOOK])).tolist()
            place += _LOOK
        chunk, ready = ready[:wanted], ready[wanted:]
        left -= len(chunk)
        yield chunk
