"""Positions of a linkage along a motion, continued from the drawing in small steps."""

import numpy as np

from mbs.vehicle.linkages.linkage import Array, Linkage, NotReachedError, Position

HEAVE, ROLL, STEER = np.array([1.0, 1.0, 0.0]), np.array([1.0, -1.0, 0.0]), np.array([0.0, 0.0, 1.0])
"""Motions: rates of the travels of the left and the right wheel and of the rack."""
STEP, LEAST_STEP = 0.004, 1e-6  # m: of the continuation
ROUND_OFF = 1e-9  # m
STRAY = 0.2  # of a step: farther from its tangent a position may be on another branch


def reached(
    linkage: Linkage, direction: Array, values: Array, start: Position | None = None
) -> tuple[list[Position], float | None]:
    """Positions at rising or falling values from zero on.

    `direction`: travels of the left and the right wheel and of the rack per value, shape (3,); `values`: all of one
    sign, farther and farther from zero, m, shape (n,); `start`: where the value is zero; by default as drawn.

    Returns
    -------
    list of Position, float or None
        As many as can be reached, and where the linkage ends if that is before the last value.
    """
    positions: list[Position] = []
    at = start = start or linkage.drawn
    current = 0.0
    for value in values:
        step = STEP
        while current != value:
            target = value if abs(value - current) <= step else current + np.sign(value - current) * step
            try:
                next_position = _next(linkage, start, at, direction, current, float(target))
            except NotReachedError:
                step = 0.5 * min(step, abs(float(target) - current))
                if step < LEAST_STEP:
                    return positions, current
                continue
            at, current, step = next_position, float(target), min(STEP, 2.0 * step)
        positions.append(at)
    return positions, None


def _next(linkage: Linkage, start: Position, at: Position, direction: Array, now: float, ahead: float) -> Position:
    """The position at the next value, near the tangent."""
    change = at.tangent @ direction * (ahead - now)
    travel, rack = start.travel + ahead * direction[:2], start.rack + ahead * float(direction[2])
    position = linkage.solve(at.q + change, travel, rack)
    if np.linalg.norm(position.q - at.q - change) > STRAY * np.linalg.norm(change) + ROUND_OFF:
        raise NotReachedError(f"the position at {ahead:g} m is not near the tangent")
    return position
