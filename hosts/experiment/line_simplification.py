"""Fewer points of a line, such that it looks the same."""

import numpy as np
from numpy.typing import NDArray

MOST = 1500
"""Points of a drawn line: about two for each pixel across a plot on a large screen."""


def thinned(x: NDArray[np.float64], y: NDArray[np.float64], most: int = MOST) -> NDArray[np.intp]:
    """Indices of points that are kept: ends, and of each stretch its smallest and largest x and y.

    `x`, `y`: NaN where there is no point, shape (n,); a gap stays one; `most`: about how many are kept.
    """
    n = len(x)
    stretches = max(1, most // 4)
    if n <= most:
        return np.arange(n)
    length = -(-n // stretches)
    starts = np.arange(0, n, length)
    indices = [np.array([0, n - 1])]
    for values in (x, y):
        for worst, choose in ((np.inf, np.argmin), (-np.inf, np.argmax)):
            padded = np.full(len(starts) * length, worst)
            padded[:n] = np.where(np.isnan(values), worst, values)
            indices.append(starts + choose(padded.reshape(len(starts), length), axis=1))
    is_gap = np.isnan(x) | np.isnan(y)
    edges = np.flatnonzero(is_gap[1:] != is_gap[:-1])
    if len(edges) <= most:
        indices += [edges, edges + 1]
    return np.asarray(np.unique(np.minimum(np.concatenate(indices), n - 1)), np.intp)
