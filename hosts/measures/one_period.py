"""One period of sinusoidal steering: delay, gain and hysteresis of the response."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import correlate, correlation_lags

from hosts.measures.peak import top


@dataclass(frozen=True)
class OnePeriod:
    """Measures of one quantity."""

    correlation_lag: float
    """Shift at which it correlates best with the steering, s; positive: later."""
    correlation: float
    """Coefficient of correlation at that shift, -1 to 1."""
    first_lag: float
    second_lag: float
    """`first_lag`, `second_lag`: from the first peak of the steering to that of the quantity, and from the second to
    the second, s."""
    first_ratio: float
    second_ratio: float
    """`first_ratio`, `second_ratio`: peaks over peaks, in units of quantity over angle."""
    hysteresis: float
    """Area of the loop over the steering angle, over that of the ellipse in the same rectangle, pi times both
    amplitudes; the sine of the lag in phase where both are sinusoidal."""


NOTHING = OnePeriod(*7 * (math.nan,))


def correlation_lag(
    excitation: NDArray[np.float64], answer: NDArray[np.float64], interval: float, longest: float
) -> tuple[float, float]:
    """Shift at which two signals correlate best.

    `excitation`, `answer`: at even times, shape (n,); they are taken as zero outside; `interval`: between samples, s;
    `longest`: largest shift that is looked at, s. Returns `lag` and `correlation`: how much later the answer comes, s,
    between samples by a parabola; and the coefficient there.
    """
    lags = correlation_lags(len(answer), len(excitation)) * interval
    product = correlate(answer, excitation) / math.sqrt(float(np.dot(excitation, excitation) * np.dot(answer, answer)))
    within = np.abs(lags) <= longest + 1e-9
    return top(lags[within], product[within])


def one_period(
    time: NDArray[np.float64], steering: NDArray[np.float64], values: NDArray[np.float64], longest: float = 0.9
) -> OnePeriod:
    """Measures of the response of one quantity to one period; all NaN where a signal is zero or not finite.

    `time`: even, s, shape (n,); `steering`, `values`: less their values before the period, shape (n,); `values` has the
    sign of the steering in a steady state; `longest`: largest lag that is looked for, s; less than half of the period.
    """
    if len(time) < 5 or not np.isfinite(values).all() or not values.any() or not steering.any():
        return NOTHING
    lag, correlation = correlation_lag(steering, values, float(time[1] - time[0]), longest)
    side = math.copysign(1.0, float(steering[np.flatnonzero(np.abs(steering) > 0.5 * np.abs(steering).max())[0]]))
    lags, ratios = [], []
    for direction in (side, -side):
        at, height = top(time, direction * steering)
        near = (time >= at - 0.1 * longest) & (time <= at + longest)
        when, answer = top(time[near], direction * values[near])
        lags.append(when - at)
        ratios.append(answer / height)
    area = 0.5 * abs(float(np.sum(steering[:-1] * values[1:] - steering[1:] * values[:-1])))
    ellipse = math.pi * 0.25 * float(np.ptp(steering) * np.ptp(values))
    return OnePeriod(lag, correlation, lags[0], lags[1], ratios[0], ratios[1], area / ellipse)
