"""Geometry of a disturbed turn: its circle, the yaw rate on the circle, the distance from it."""

import numpy as np
from numpy.typing import NDArray


def circle_through(x: NDArray[np.float64], y: NDArray[np.float64]) -> tuple[float, float, float]:
    """Least-squares circle through points, after Kåsa. `x`, `y`: m, shape (n,).

    Returns `centre_x`, `centre_y` and `radius`, m.
    """
    # Relative to the mean, which reduces rounding errors.
    mx, my = float(x.mean()), float(y.mean())
    u, v = x - mx, y - my
    (cu, cv, c), *_ = np.linalg.lstsq(np.column_stack([2.0 * u, 2.0 * v, np.ones(len(u))]), u**2 + v**2, rcond=None)
    return float(mx + cu), float(my + cv), float(np.sqrt(c + cu**2 + cv**2))


def distance_from_circle(
    x: NDArray[np.float64], y: NDArray[np.float64], circle: tuple[float, float, float]
) -> NDArray[np.float64]:
    """Distance of points from a circle, m, positive outside, shape (n,). `circle`: result of `circle_through`."""
    return np.asarray(np.hypot(x - circle[0], y - circle[1]) - circle[2])


def yaw_rate_on_circle(speed: NDArray[np.float64], radius: float) -> NDArray[np.float64]:
    """Yaw rate of a car on a circle, rad/s, shape (n,). `speed`: m/s, shape (n,); `radius`: m; negative: right turn."""
    return np.asarray(speed / radius)
