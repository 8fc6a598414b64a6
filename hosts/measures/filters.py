"""Resampling, level crossings and peaks of signals, and the phaseless low-pass filter of vehicle tests."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ali3.low_pass import phaseless_low_pass as phaseless_low_pass  # beside the other filters of signals


def resample(
    time: ArrayLike, values: ArrayLike, interval: float, first: float | None = None
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Resample a signal at equally spaced times, by linear interpolation.

    Parameters
    ----------
    time : array_like, shape (n,)
        s, increasing; need not be equally spaced.
    values : array_like, shape (n,)
    interval : float
        Time between the new samples, s; if it is longer than between the old ones, filter the signal before.
    first : float, optional
        Time of the first new sample, s; by default the time of the first old one.

    Returns
    -------
    time, values : ndarray of shape (m,)
        Samples from `first` to the end of the signal.

    Raises
    ------
    ValueError
        If there are fewer than two samples, or time does not increase, or a value is not finite.
    """
    t, x = np.asarray(time, float), np.asarray(values, float)
    if len(t) < 2 or len(t) != len(x) or not (np.diff(t) > 0.0).all():
        raise ValueError(f"A signal needs two samples or more at increasing times; there are {len(t)}.")
    if not interval > 0.0:
        raise ValueError(f"The interval is {interval:g} s; it must be positive.")
    if not np.isfinite(x).all():
        raise ValueError(f"The signal is not finite at {t[~np.isfinite(x)][0]:g} s.")
    # 5e-4 of an interval, so that rounding errors do not remove the last sample.
    start = t[0] if first is None else first
    even_times = start + interval * np.arange(int((t[-1] - start) / interval + 5e-4) + 1)
    return np.asarray(even_times, float), np.asarray(np.interp(even_times, t, x), float)


def crossing(time: NDArray[np.float64], values: NDArray[np.float64], level: float, after: float = -np.inf) -> float:
    """First time at which a signal crosses a level, s, by linear interpolation; NaN if it does not.

    `time`, `values`: shape (n,); `after`: time before which crossings do not count, s.
    """
    is_below = np.signbit(values - level)
    candidates = np.flatnonzero((is_below[1:] != is_below[:-1]) & (time[1:] > after))
    for k in candidates:
        a, b = values[k] - level, values[k + 1] - level
        t = float(time[k] - a * (time[k + 1] - time[k]) / (b - a))
        if t >= after:
            return t
    return float("nan")


def interpolated_peak(x: NDArray[np.float64], y: NDArray[np.float64]) -> tuple[float, float]:
    """Position and height of the peak of a signal, by a parabola through the largest sample and its neighbours.

    `x`, `y`: equally spaced samples, shape (n,).
    """
    k = int(np.argmax(y))
    if not 0 < k < len(y) - 1:
        return float(x[k]), float(y[k])
    a, b, c = float(y[k - 1]), float(y[k]), float(y[k + 1])
    curvature = a - 2.0 * b + c
    shift = 0.5 * (a - c) / curvature if curvature < 0.0 else 0.0
    return float(x[k] + shift * (x[k + 1] - x[k])), b - 0.25 * (a - c) * shift


def first_direction(values: NDArray[np.float64]) -> float:
    """Sign of the first half wave of a signal: of its first sample above half of the largest; 1 for a zero signal."""
    indices = np.flatnonzero(np.abs(values) > 0.5 * np.abs(values).max())
    return math.copysign(1.0, float(values[indices[0]])) if len(indices) else 1.0
