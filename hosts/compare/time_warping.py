"""Dynamic time warping of two equally long signals within a band."""

import math

import numpy as np
from numpy.typing import NDArray


def warp(
    y: NDArray[np.float64], x: NDArray[np.float64], window: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Both signals along the path of the least sum of squared differences.

    `y`, `x`: shape (n,); `window`: half width of the Sakoe-Chiba band as a part of n.

    Returns
    -------
    y_warped, x_warped : ndarray of shape (m,), n <= m < 2 n

    Notes
    -----
    The table of sums is filled along its anti-diagonals, whose cells depend on earlier ones only (Sakoe and Chiba,
    1978, symmetric steps with weight 1 each).
    """
    n = len(y)
    band = max(1, math.ceil(window * n)) - 1
    # Cell (i, j) is stored by its anti-diagonal d = i + j and i - j + band.
    width = 2 * band + 1
    total = np.full((2 * n - 1, width + 2), np.inf)
    for d in range(2 * n - 1):
        low, high = max(0, d - n + 1, -((band - d) // 2)), min(n - 1, d, (d + band) // 2)
        i = np.arange(low, high + 1)
        cell = 2 * i - d + band + 1
        cost = (y[i] - x[d - i]) ** 2
        if d == 0:
            total[0, cell] = cost
            continue
        before = np.minimum(total[d - 1, cell - 1], total[d - 1, cell + 1])
        if d > 1:
            before = np.minimum(before, total[d - 2, cell])
        total[d, cell] = cost + before
    return _along_path(total, y, x, band)


def _along_path(
    total: NDArray[np.float64], y: NDArray[np.float64], x: NDArray[np.float64], band: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    i = j = len(y) - 1
    path = [(i, j)]
    while i or j:
        d, cell = i + j, i - j + band + 1
        steps = [(total[d - 1, cell - 1], i - 1, j), (total[d - 1, cell + 1], i, j - 1)]
        if d > 1:
            steps.append((total[d - 2, cell], i - 1, j - 1))
        _, i, j = min((s for s in steps if s[1] >= 0 and s[2] >= 0), key=lambda s: s[0])
        path.append((i, j))
    rows, columns = np.array(path[::-1]).T
    return y[rows], x[columns]
