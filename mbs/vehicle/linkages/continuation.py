"""Positions of a linkage along a motion, by continuation from the drawing."""

import numpy as np

from mbs.vehicle.linkages.linkage import Array, Linkage, NotReachedError, Position

HEAVE, ROLL, STEER = np.array([1.0, 1.0, 0.0]), np.array([1.0, -1.0, 0.0]), np.array([0.0, 0.0, 1.0])
"""Motions: rates of the travels of the left and the right wheel and of the rack."""
MAX_STEP = 0.004  # m, of the continuation
MIN_STEP = 1e-6  # m
ROUND_OFF = 1e-9  # m
MAX_DEVIATION = 0.2  # from the tangent, relative to the step: a farther position may be on another branch


def positions_along(
    linkage: Linkage, direction: Array, values: Array, start: Position | None = None
) -> tuple[list[Position], float | None]:
    """Find positions along a motion at values that start from zero.

    `direction`: travels of the left and the right wheel and of the rack per value, shape (3,); `values`: values of one
    sign and increasing magnitude, m, shape (n,); `start`: position at the value zero, by default as drawn.

    Returns
    -------
    list of Position, float or None
        The positions that the linkage reaches, and its limit if that is before the last value.
    """
    positions: list[Position] = []
    position = start = start or linkage.drawn
    current = 0.0
    for value in values:
        step = MAX_STEP
        while current != value:
            target = value if abs(value - current) <= step else current + np.sign(value - current) * step
            try:
                following = _next_position(linkage, start, position, direction, current, float(target))
            except NotReachedError:
                step = 0.5 * min(step, abs(float(target) - current))
                if step < MIN_STEP:
                    return positions, current
                continue
            position, current, step = following, float(target), min(MAX_STEP, 2.0 * step)
        positions.append(position)
    return positions, None


def _next_position(
    linkage: Linkage, start: Position, position: Position, direction: Array, current: float, target: float
) -> Position:
    """Position at the next value. Raises `NotReachedError` if there is none near the tangent."""
    change = position.tangent @ direction * (target - current)
    travel, rack = start.travel + target * direction[:2], start.rack + target * float(direction[2])
    next_position = linkage.solve(position.q + change, travel, rack)
    if np.linalg.norm(next_position.q - position.q - change) > MAX_DEVIATION * np.linalg.norm(change) + ROUND_OFF:
        raise NotReachedError(f"the position at {target:g} m is not near the tangent")
    return next_position
