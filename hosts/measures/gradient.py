"""The slope of a straight line through a range of points."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import stats

_FEWEST = 5
_SPAN = 0.8


@dataclass(frozen=True)
class Gradient:
    """A regression line."""

    slope: float
    intercept: float
    """`slope`, `intercept`: NaN where there is no line."""
    error: float
    """Standard error of the slope."""


NONE = Gradient(math.nan, math.nan, math.nan)
"""The gradient where no line can be fitted."""


def gradient(x: NDArray[np.float64], y: NDArray[np.float64], low: float, high: float) -> Gradient:
    """Least squares over the points whose x lies in a range, all x weighing the same however dense the points are.

    `x`, `y`: points, shape (n,); those that are not finite do not count; `low`, `high`: range of x. Result: `NONE`
    where the points do not span most of the range.
    """
    chosen = np.isfinite(x) & np.isfinite(y) & (x >= low) & (x <= high)
    if chosen.sum() < _FEWEST or np.ptp(x[chosen]) < _SPAN * (high - low):
        return NONE
    # Where the speed rises evenly, points are far denser at low accelerations; means of equal parts of x are not.
    edges = np.linspace(low, high, max(_FEWEST, min(30, int(chosen.sum()) // 4)) + 1)
    at, mean = (np.asarray(stats.binned_statistic(x[chosen], v[chosen], "mean", edges).statistic) for v in (x, y))
    finite = np.isfinite(at)
    if finite.sum() < _FEWEST - 2:
        return NONE
    line = stats.linregress(at[finite].tolist(), mean[finite].tolist())
    return Gradient(float(line.slope), float(line.intercept), float(line.stderr))
