"""Reduces the points of a line without a visible change."""

import numpy as np
from numpy.typing import NDArray

MOST_POINTS = 1500
"""Default number of points of a line: about two for each pixel of the width of a plot on a large screen."""


def thinned_indices(x: NDArray[np.float64], y: NDArray[np.float64], most_points: int = MOST_POINTS) -> NDArray[np.intp]:
    """Indices of points that are kept: both ends, and the extremes of x and y of each of equal stretches.

    `x`, `y`: shape (n,), NaN in gaps, whose edges are kept; `most_points`: approximate number of points.
    """
    n = len(x)
    stretches = max(1, most_points // 4)
    if n <= most_points:
        return np.arange(n)
    length = -(-n // stretches)
    starts = np.arange(0, n, length)
    indices = [np.array([0, n - 1])]
    for values in (x, y):
        for fill, extreme in ((np.inf, np.argmin), (-np.inf, np.argmax)):
            padded = np.full(len(starts) * length, fill)
            padded[:n] = np.where(np.isnan(values), fill, values)
            indices.append(starts + extreme(padded.reshape(len(starts), length), axis=1))
    is_gap = np.isnan(x) | np.isnan(y)
    edges = np.flatnonzero(is_gap[1:] != is_gap[:-1])
    if len(edges) <= most_points:
        indices += [edges, edges + 1]
    return np.asarray(np.unique(np.minimum(np.concatenate(indices), n - 1)), np.intp)
