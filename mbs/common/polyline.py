"""The points that a polyline needs."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray


def needed_points(n: int, off: Callable[[int, int], NDArray[np.float64]], least: float) -> list[int]:
    """Indices of points without which straight lines would miss others (Ramer 1972, Douglas and Peucker 1973).

    `n`: number of points; the first and the last are kept; `off`: gives how far the straight line between two points
    misses each one between them; `least`: up to which a point is not needed.
    """
    keep, waiting = {0, n - 1}, [(0, n - 1)]  # no recursion, which a staircase of many points would exhaust
    while waiting:
        a, b = waiting.pop()
        if b - a < 2:
            continue
        missed = off(a, b)
        k = int(np.argmax(missed))
        if missed[k] > least:
            keep.add(a + 1 + k)
            waiting += [(a, a + 1 + k), (a + 1 + k, b)]
    return sorted(keep)
