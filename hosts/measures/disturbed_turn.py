"""Measures of a disturbed turn: its circle, the yaw rate that keeps the circle, the way off it."""

import numpy as np
from numpy.typing import NDArray


def circle_through(x: NDArray[np.float64], y: NDArray[np.float64]) -> tuple[float, float, float]:
    """Circle of least squares through points (of their squared distances, after Kåsa). `x`, `y`: in m, shape (n,).

    Returns `centre_x`, `centre_y` and `radius`: in m.
    """
    # around their mean, for the numbers' sake
    mx, my = float(x.mean()), float(y.mean())
    u, v = x - mx, y - my
    (cu, cv, c), *_ = np.linalg.lstsq(np.column_stack([2.0 * u, 2.0 * v, np.ones(len(u))]), u**2 + v**2, rcond=None)
    return float(mx + cu), float(my + cv), float(np.sqrt(c + cu**2 + cv**2))


def off_circle(
    x: NDArray[np.float64], y: NDArray[np.float64], circle: tuple[float, float, float]
) -> NDArray[np.float64]:
    """Distance of points from a circle, m, positive outside, of shape (n,)."""
    return np.asarray(np.hypot(x - circle[0], y - circle[1]) - circle[2])


def yaw_rate_on_circle(speed: NDArray[np.float64], radius: float) -> NDArray[np.float64]:
    """Yaw rate with which a car of a speed stays on the circle, rad/s.

    `speed`: in m/s, shape (n,); `radius`: in m; negative: to the right.
    """
    return np.asarray(speed / radius)
