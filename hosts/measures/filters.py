"""Recorded signals on an even grid of time, and the phaseless low-pass of vehicle tests."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ali3.low_pass import phaseless_low_pass as phaseless_low_pass


def resample(
    time: ArrayLike, values: ArrayLike, interval: float, first: float | None = None
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """A signal at even times, linear in between.

    Parameters
    ----------
    time : array_like, shape (n,)
        s, increasing; need not be even.
    values : array_like, shape (n,)
    interval : float
        Between the new samples, s; longer than that of the old ones it needs a low-pass before.
    first : float, optional
        Time of the first new sample, s; by default that of the first old one.

    Returns
    -------
    time, values : ndarray of shape (m,)
        From `first` to the last that is reached.

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
    # half a thousandth of an interval: the last sample must not be lost for rounding
    begin = t[0] if first is None else first
    even = begin + interval * np.arange(int((t[-1] - begin) / interval + 5e-4) + 1)
    return np.asarray(even, float), np.asarray(np.interp(even, t, x), float)


def crossing(time: NDArray[np.float64], values: NDArray[np.float64], level: float, after: float = -np.inf) -> float:
    """When a signal first passes a level, by linear interpolation.

    `time`, `values`: shape (n,); `after`: earlier passages do not count, s. Result: in s; NaN if it never does.
    """
    side = np.signbit(values - level)
    passed = np.flatnonzero((side[1:] != side[:-1]) & (time[1:] > after))
    for k in passed:
        a, b = values[k] - level, values[k + 1] - level
        t = float(time[k] - a * (time[k + 1] - time[k]) / (b - a))
        if t >= after:
            return t
    return float("nan")
