"""Mobility of closed loops: positions along their motions, and the closing errors there.

Redundant conditions r of an overconstrained loop contradict each other if the drawing is not exact. With the left
singular vectors U of their derivatives whose singular values are almost zero, the closing error at a position is U' r,
the misfit. A loop whose misfit is zero along its motion moves as drawn.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mbs.compiler.loop_conditions import Loops, Poses

Array = NDArray[np.float64]

STEP = 0.3
"""Largest rotation (rad) or translation (parts of the size) from one position to the next."""
POSITIONS = 8
"""Largest number of positions along a motion, to each side."""
RANK_MARGIN = 1.5
"""Least ratio of the smallest singular value that is not redundant to the tolerance, at a position that counts."""
ITERATIONS = 30
CONVERGED = 1e-15


@dataclass
class ClosedLoops:
    """Loops at a position at which all conditions except the redundant ones are closed."""

    poses: Poses
    rank: int
    """Number of singular values above the tolerance."""
    values: Array
    """Singular values, the largest 1, padded by zeros to the number of unknowns, shape (n,)."""
    left: Array
    """Left singular vectors of the other values, shape (m, m - rank)."""
    right: Array
    """Right singular vectors of the other values, shape (n, n - rank)."""
    misfit: Array
    """Closing errors, parts of the size, shape (m - rank,)."""
    converged: bool
    """Whether the iteration has converged."""

    @property
    def largest_misfit(self) -> float:
        """Largest closing error, part of the size."""
        return float(np.max(np.abs(self.misfit), initial=0.0))


def close_loops(loops: Loops, poses: Poses, tolerance: float, g: Array | None = None) -> ClosedLoops:
    """Close loops by Gauss-Newton from `poses`, without singular values below `tolerance` times the largest."""
    previous_size = np.inf
    for k in range(ITERATIONS):
        r, J, _ = loops.evaluate(poses, g)
        U, s, Vt = np.linalg.svd(J)
        rank = int(np.sum(s > tolerance * s[0]))
        dx = -Vt[:rank].T @ ((U[:, :rank].T @ r) / s[:rank])
        size = float(np.max(np.abs(dx), initial=0.0))
        values = np.zeros(J.shape[1])
        values[: len(s)] = s / s[0]
        is_stationary = size <= CONVERGED or (size < 1e-11 and size > 0.3 * previous_size)
        if is_stationary or k == ITERATIONS - 1 or size > 2.0:
            converged = size < 1e-11
            return ClosedLoops(poses, rank, values, U[:, rank:], Vt[rank:].T, U[:, rank:].T @ r, converged)
        poses, previous_size = loops.move(poses, dx), size
    raise AssertionError("not reached")


def trace_motion(
    loops: Loops, start: ClosedLoops, tolerance: float, g: Array | None = None, seed: int = 0
) -> list[ClosedLoops]:
    """Positions along the motions from a position, without positions of lower rank."""
    random = np.random.default_rng(seed)
    freedoms = start.right.shape[1]
    positions = [start]
    for _ in range(1 if freedoms == 1 else freedoms + 1):
        direction = start.right @ random.standard_normal(freedoms)
        for sign in (1.0, -1.0):
            positions += _trace_direction(loops, start, sign * direction, tolerance, g)
    rank = max(c.rank for c in positions)
    return [c for c in positions if c.rank == rank and (rank == 0 or c.values[rank - 1] > RANK_MARGIN * tolerance)]


def _trace_direction(
    loops: Loops, start: ClosedLoops, direction: Array, tolerance: float, g: Array | None
) -> list[ClosedLoops]:
    positions: list[ClosedLoops] = []
    current, step = start, STEP
    while len(positions) < POSITIONS and step > STEP / 10.0:
        tangent = current.right @ (current.right.T @ direction)
        if not np.max(np.abs(tangent), initial=0.0) > 1e-3 * np.max(np.abs(direction)):
            break
        tangent /= np.max(np.abs(tangent))
        closed = close_loops(loops, loops.move(current.poses, step * tangent), tolerance, g)
        if not closed.converged or closed.largest_misfit > 0.1 * step:
            step *= 0.5
            continue
        positions.append(closed)
        current, direction, step = closed, tangent, min(STEP, 2.0 * step)
    return positions
