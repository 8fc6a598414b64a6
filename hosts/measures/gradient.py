"""The slope of a straight line through a range of points."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import stats

_MIN_POINTS = 5
_MIN_SPAN = 0.8


@dataclass(frozen=True)
class Gradient:
    """A regression line."""

    slope: float
    """NaN if there is no line."""
    intercept: float
    """NaN if there is no line."""
    error: float
    """Standard error of the slope."""


NONE = Gradient(math.nan, math.nan, math.nan)
"""The gradient if no line can be fitted."""


def gradient(x: NDArray[np.float64], y: NDArray[np.float64], low: float, high: float) -> Gradient:
    """Regression line through the points with x in a range, with equal weight of all parts of the range.

    `x`, `y`: shape (n,), points that are not finite are ignored; `low`, `high`: range of x. Returns `NONE` where the
    points do not span most of the range.
    """
    selected = np.isfinite(x) & np.isfinite(y) & (x >= low) & (x <= high)
    if selected.sum() < _MIN_POINTS or np.ptp(x[selected]) < _MIN_SPAN * (high - low):
        return NONE
    # With a constant rise of the speed, points are denser at low accelerations; means over bins of x are not.
    edges = np.linspace(low, high, max(_MIN_POINTS, min(30, int(selected.sum()) // 4)) + 1)
    bin_x, bin_y = (
        np.asarray(stats.binned_statistic(x[selected], v[selected], "mean", edges).statistic) for v in (x, y)
    )
    finite = np.isfinite(bin_x)
    if finite.sum() < _MIN_POINTS - 2:
        return NONE
    line = stats.linregress(bin_x[finite].tolist(), bin_y[finite].tolist())
    return Gradient(float(line.slope), float(line.intercept), float(line.stderr))
