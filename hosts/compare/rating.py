"""A rating of two signals by corridor, phase, magnitude and slope, like that of ISO/TS 18571.

The formulas are those that public descriptions give of ISO/TS 18571:2014 (Gehre, Gades, Wernicke: Objective rating of
signals using test and simulation responses, ESV 2009; Zhan, Fu, Yang: Enhanced error assessment of response
time histories, SAE 2011-01-0245); its text was not read. Like: the standard is for impacts sampled at 10 kHz, here a
signal is taken at no more than 1000 equally spaced points, whatever its length.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hosts.compare.deviations import is_constant
from hosts.compare.time_warping import warped

POINTS = 1000
# of the largest measured value
_INNER = 0.05
_OUTER = 0.5
_CORRIDOR_POWER = 2.0
_LONGEST_SHIFT = 0.2  # of the length
_LARGEST_MAGNITUDE_ERROR = 0.5
_WINDOW = 0.1
_LARGEST_SLOPE_ERROR = 2.0
_SMOOTHED = 9
_WEIGHTS = (0.4, 0.2, 0.2, 0.2)
_GRADES = ((0.94, "excellent"), (0.80, "good"), (0.58, "fair"), (0.0, "poor"))


@dataclass(frozen=True)
class Rating:
    """Scores between 0 and 1; NaN where the measured signal is constant."""

    corridor: float
    phase: float
    magnitude: float
    slope: float
    overall: float

    @property
    def grade(self) -> str:
        """In a word, by the limits 0.94, 0.80 and 0.58."""
        return next((word for limit, word in _GRADES if self.overall > limit), "poor" if self.overall >= 0 else "none")


def rating(measured: ArrayLike, simulated: ArrayLike) -> Rating:
    """Rate a simulated signal.

    `measured`, `simulated`: at the same, equally spaced times, shape (n,); n at least 10.
    """
    y, x = np.asarray(measured, float), np.asarray(simulated, float)
    if is_constant(y):
        return Rating(*5 * (math.nan,))
    shift = _best_shift(y, x)
    z, p = _corridor(y, x), max(0.0, 1.0 - abs(shift) / (_LONGEST_SHIFT * len(y)))
    y_cut, x_cut = (y[: len(y) - shift], x[shift:]) if shift >= 0 else (y[-shift:], x[:shift])
    m, s = _magnitude(y_cut, x_cut), _slope(y_cut, x_cut)
    return Rating(z, p, m, s, float(np.dot(_WEIGHTS, (z, p, m, s))))


def on_equal_steps(
    time: NDArray[np.float64], *signals: NDArray[np.float64]
) -> tuple[NDArray[np.float64], list[NDArray[np.float64]]]:
    """Signals at equally spaced times, as many as they have samples but no more than `POINTS`; linear in between."""
    grid = np.linspace(time[0], time[-1], max(10, min(POINTS, len(time))))
    return grid, [np.interp(grid, time, s) for s in signals]


def _corridor(y: NDArray[np.float64], x: NDArray[np.float64]) -> float:
    largest = float(np.max(np.abs(y)))
    inner, outer = _INNER * largest, _OUTER * largest
    inside = np.clip((outer - np.abs(x - y)) / (outer - inner), 0.0, 1.0)
    return float(np.mean(inside**_CORRIDOR_POWER))


def _best_shift(y: NDArray[np.float64], x: NDArray[np.float64]) -> int:
    """Samples by which the simulation is late where both correlate best; the smallest of equals."""
    if is_constant(x):
        return 0
    best, results = float(np.corrcoef(y, x)[0, 1]), 0
    n = len(y)
    for k in range(1, int(_LONGEST_SHIFT * n) + 1):
        for shift, (a, b) in ((k, (y[: n - k], x[k:])), (-k, (y[k:], x[: n - k]))):
            spread = np.std(a) * np.std(b)
            value = float(np.mean((a - a.mean()) * (b - b.mean())) / spread) if spread > 0.0 else -1.0
            if value > best + 1e-12:
                best, results = value, shift
    return results


def _magnitude(y: NDArray[np.float64], x: NDArray[np.float64]) -> float:
    y_warped, x_warped = warped(y, x, _WINDOW)
    size = float(np.sum(np.abs(y_warped)))
    error = float(np.sum(np.abs(x_warped - y_warped))) / size if size > 0.0 else math.inf
    return max(0.0, 1.0 - error / _LARGEST_MAGNITUDE_ERROR)


def _slope(y: NDArray[np.float64], x: NDArray[np.float64]) -> float:
    a, b = _smooth(np.gradient(y)), _smooth(np.gradient(x))
    size = float(np.sum(np.abs(a)))
    error = float(np.sum(np.abs(b - a))) / size if size > 0.0 else math.inf
    return max(0.0, 1.0 - error / _LARGEST_SLOPE_ERROR)


def _smooth(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Mean over nine samples, over fewer but as many on both sides at the ends."""
    half = min(_SMOOTHED // 2, (len(values) - 1) // 2)
    total = np.concatenate(([0.0], np.cumsum(values)))
    k = np.arange(len(values))
    reach = np.minimum(half, np.minimum(k, len(values) - 1 - k))
    return np.asarray((total[k + reach + 1] - total[k - reach]) / (2 * reach + 1))
