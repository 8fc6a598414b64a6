"""Mobility of closed loops: positions along their motions, and the closing errors there.

Redundant conditions of an overconstrained loop contradict each other where the drawing is not exact. With U the left
singular vectors of the conditions' derivatives that belong to singular values next to nothing, what cannot be closed
at a position is U' r: the misfit. A loop whose misfit is nothing along its motion moves as drawn.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mbs.compiler.loop_conditions import Loops, Places

Array = NDArray[np.float64]

STEP = 0.3
"""Largest turn (rad) or shift (sizes) from one position to the next."""
POSITIONS = 8
"""Positions along a motion, to each side."""
CLEAR = 1.5
"""A position counts where the smallest singular value that is not redundant is this multiple of the tolerance."""
ITERATIONS = 30
CONVERGED = 1e-15


@dataclass
class Closed:
    """Loops closed as far as they can be."""

    places: Places
    rank: int
    """Number of singular values above the tolerance."""
    values: Array
    """Shape (n,): singular values, the largest 1, padded by zeros to the number of unknowns."""
    left: Array
    right: Array
    """`left`, `right`: singular vectors of the others, shapes (m, m - rank) and (n, n - rank)."""
    misfit: Array
    """Shape (m - rank,): what stays open, in sizes."""
    good: bool
    """Whether all else is closed."""

    @property
    def open(self) -> float:
        """Largest misfit."""
        return float(np.max(np.abs(self.misfit), initial=0.0))


def close(loops: Loops, places: Places, tolerance: float, g: Array | None = None) -> Closed:
    """Gauss-Newton from `places`, without the singular values below `tolerance` times the largest."""
    last = np.inf
    for k in range(ITERATIONS):
        r, J, _ = loops.evaluate(places, g)
        U, s, Vt = np.linalg.svd(J)
        rank = int(np.sum(s > tolerance * s[0]))
        dx = -Vt[:rank].T @ ((U[:, :rank].T @ r) / s[:rank])
        size = float(np.max(np.abs(dx), initial=0.0))
        values = np.zeros(J.shape[1])
        values[: len(s)] = s / s[0]
        stopped = size <= CONVERGED or (size < 1e-11 and size > 0.3 * last)
        if stopped or k == ITERATIONS - 1 or size > 2.0:
            good = size < 1e-11
            return Closed(places, rank, values, U[:, rank:], Vt[rank:].T, U[:, rank:].T @ r, good)
        places, last = loops.move(places, dx), size
    raise AssertionError("not reached")


def motion(loops: Loops, start: Closed, tolerance: float, g: Array | None = None, seed: int = 0) -> list[Closed]:
    """Positions along the motions that start at a position, those where the rank falls left out."""
    random = np.random.default_rng(seed)
    free = start.right.shape[1]
    positions = [start]
    for _ in range(1 if free == 1 else free + 1):
        direction = start.right @ random.standard_normal(free)
        for sign in (1.0, -1.0):
            positions += _ray(loops, start, sign * direction, tolerance, g)
    rank = max(c.rank for c in positions)
    return [c for c in positions if c.rank == rank and (rank == 0 or c.values[rank - 1] > CLEAR * tolerance)]


def _ray(loops: Loops, start: Closed, direction: Array, tolerance: float, g: Array | None) -> list[Closed]:
    positions: list[Closed] = []
    current, step = start, STEP
    while len(positions) < POSITIONS and step > STEP / 10.0:
        along = current.right @ (current.right.T @ direction)
        if not np.max(np.abs(along), initial=0.0) > 1e-3 * np.max(np.abs(direction)):
            break
        along /= np.max(np.abs(along))
        closed = close(loops, loops.move(current.places, step * along), tolerance, g)
        if not closed.good or closed.open > 0.1 * step:
            step *= 0.5
            continue
        positions.append(closed)
        current, direction, step = closed, along, min(STEP, 2.0 * step)
    return positions
