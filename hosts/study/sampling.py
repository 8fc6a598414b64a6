"""Points of a grid, a block at a time, so that a million of them need no memory; see `hosts.study.drawn_points`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray


class Sampler(Protocol):
    """Numbers that say where a point lies."""

    count: int

    def block(self, first: int, count: int) -> NDArray[np.float64]:
        """Points `first` to `first + count - 1`, of shape (count, dimensions), in [0, 1)."""
        ...


class Grid:
    """All combinations; the last dimension runs fastest. `lengths`: values of each dimension."""

    def __init__(self, lengths: Sequence[int]) -> None:
        self._lengths = tuple(lengths)
        self.count = math.prod(self._lengths)

    def block(self, first: int, count: int) -> NDArray[np.float64]:
        """Middles of equal parts of [0, 1), one for each value; see `Sampler`."""
        places = np.unravel_index(np.arange(first, first + count), self._lengths)
        return (np.stack(places, axis=1) + 0.5) / np.array(self._lengths, dtype=np.float64)
