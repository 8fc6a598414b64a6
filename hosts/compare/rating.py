"""A rating of two signals by corridor, phase, magnitude and slope, like the rating of ISO/TS 18571.

The formulas are from public descriptions of ISO/TS 18571:2014 (Gehre, Gades, Wernicke: Objective rating of signals
using test and simulation responses, ESV 2009; Zhan, Fu, Yang: Enhanced error assessment of response time histories,
SAE 2011-01-0245); its text was not read. The standard is for impacts sampled at 10 kHz; here a signal of any length is
resampled at no more than 1000 equally spaced points.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hosts.compare.deviations import is_constant

POINTS = 1000
_INNER = 0.05  # of the largest measured value
_OUTER = 0.5  # of the largest measured value
_CORRIDOR_POWER = 2.0
_MAX_SHIFT = 0.2  # of the length
_MAX_MAGNITUDE_ERROR = 0.5
_WARPING_WINDOW = 0.1
_MAX_SLOPE_ERROR = 2.0
_SMOOTHED_SAMPLES = 9
_WEIGHTS = (0.4, 0.2, 0.2, 0.2)
_GRADES = ((0.94, "excellent"), (0.80, "good"), (0.58, "fair"), (0.0, "poor"))


@dataclass(frozen=True)
class Rating:
    """Scores from 0 to 1; NaN if the measured signal is constant."""

    corridor: float = math.nan
    phase: float = math.nan
    magnitude: float = math.nan
    slope: float = math.nan
    overall: float = math.nan

    @property
    def grade(self) -> str:
        """The overall score as a word, by the limits 0.94, 0.80 and 0.58."""
        return next((word for limit, word in _GRADES if self.overall > limit), "poor" if self.overall >= 0 else "none")


def rating(measured: ArrayLike, simulated: ArrayLike) -> Rating:
    """Rate a simulated signal.

    `measured`, `simulated`: values at the same, equally spaced times, shape (n,); n at least 10.
    """
    y, x = np.asarray(measured, float), np.asarray(simulated, float)
    if is_constant(y):
        return Rating()
    shift = _best_shift(y, x)
    corridor, phase = _corridor_score(y, x), max(0.0, 1.0 - abs(shift) / (_MAX_SHIFT * len(y)))
    y_cut, x_cut = (y[: len(y) - shift], x[shift:]) if shift >= 0 else (y[-shift:], x[:shift])
    magnitude, slope = _magnitude_score(y_cut, x_cut), _slope_score(y_cut, x_cut)
    return Rating(corridor, phase, magnitude, slope, float(np.dot(_WEIGHTS, (corridor, phase, magnitude, slope))))


def resampled_evenly(
    time: NDArray[np.float64], *signals: NDArray[np.float64]
) -> tuple[NDArray[np.float64], list[NDArray[np.float64]]]:
    """Signals at equally spaced times by linear interpolation, with as many samples, but no more than `POINTS`."""
    grid = np.linspace(time[0], time[-1], max(10, min(POINTS, len(time))))
    return grid, [np.interp(grid, time, s) for s in signals]


def _corridor_score(y: NDArray[np.float64], x: NDArray[np.float64]) -> float:
    largest = float(np.max(np.abs(y)))
    inner, outer = _INNER * largest, _OUTER * largest
    inside = np.clip((outer - np.abs(x - y)) / (outer - inner), 0.0, 1.0)
    return float(np.mean(inside**_CORRIDOR_POWER))


def _best_shift(y: NDArray[np.float64], x: NDArray[np.float64]) -> int:
    """Samples by which the simulation lags at the best correlation; the smallest of equally good ones."""
    if is_constant(x):
        return 0
    highest, best_shift = float(np.corrcoef(y, x)[0, 1]), 0
    n = len(y)
    for k in range(1, int(_MAX_SHIFT * n) + 1):
        for shift, (a, b) in ((k, (y[: n - k], x[k:])), (-k, (y[k:], x[: n - k]))):
            spread = np.std(a) * np.std(b)
            value = float(np.mean((a - a.mean()) * (b - b.mean())) / spread) if spread > 0.0 else -1.0
            if value > highest + 1e-12:
                highest, best_shift = value, shift
    return best_shift


def _magnitude_score(y: NDArray[np.float64], x: NDArray[np.float64]) -> float:
    y_warped, x_warped = warp(y, x, _WARPING_WINDOW)
    size = float(np.sum(np.abs(y_warped)))
    error = float(np.sum(np.abs(x_warped - y_warped))) / size if size > 0.0 else math.inf
    return max(0.0, 1.0 - error / _MAX_MAGNITUDE_ERROR)


def _slope_score(y: NDArray[np.float64], x: NDArray[np.float64]) -> float:
    y_slope, x_slope = _moving_average(np.gradient(y)), _moving_average(np.gradient(x))
    size = float(np.sum(np.abs(y_slope)))
    error = float(np.sum(np.abs(x_slope - y_slope))) / size if size > 0.0 else math.inf
    return max(0.0, 1.0 - error / _MAX_SLOPE_ERROR)


def _moving_average(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Moving average over nine samples; at the ends over fewer, symmetric to the sample."""
    half = min(_SMOOTHED_SAMPLES // 2, (len(values) - 1) // 2)
    total = np.concatenate(([0.0], np.cumsum(values)))
    k = np.arange(len(values))
    half_widths = np.minimum(half, np.minimum(k, len(values) - 1 - k))
    return np.asarray((total[k + half_widths + 1] - total[k - half_widths]) / (2 * half_widths + 1))


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
