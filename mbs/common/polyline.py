"""Reduction of polylines to the points that they need."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray


def needed_points(n: int, deviations: Callable[[int, int], NDArray[np.float64]], tolerance: float) -> list[int]:
    """Indices of the points that a polyline needs within a tolerance (Ramer 1972, Douglas and Peucker 1973).

    `n`: number of points, of which the first and the last are needed; `deviations`: function of two indices that gives
    the distances of the points between them from their line; `tolerance`: largest distance of an omitted point.
    """
    needed, intervals = {0, n - 1}, [(0, n - 1)]  # not recursive: a staircase of many points would be too deep
    while intervals:
        a, b = intervals.pop()
        if b - a < 2:
            continue
        distances = deviations(a, b)
        k = int(np.argmax(distances))
        if distances[k] > tolerance:
            needed.add(a + 1 + k)
            intervals += [(a, a + 1 + k), (a + 1 + k, b)]
    return sorted(needed)
