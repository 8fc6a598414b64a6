"""One period of sinusoidal steering: delay, gain and hysteresis of the response."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import correlate, correlation_lags

from hosts.measures.peak import interpolated_peak


@dataclass(frozen=True)
class OnePeriod:
    """Measures of one quantity."""

    correlation_lag: float
    """Lag at the best correlation with the steering, s; positive: behind the steering."""
    correlation: float
    """Correlation coefficient at that lag, -1 to 1."""
    first_lag: float
    second_lag: float
    """`first_lag`, `second_lag`: from the first peak of the steering to that of the quantity, and from the second to
    the second, s."""
    first_ratio: float
    second_ratio: float
    """`first_ratio`, `second_ratio`: peaks of the quantity over those of the steering, in units of quantity over angle.
    """
    hysteresis: float
    """Area of the loop over the steering angle, over that of the ellipse in its bounding rectangle; the sine of the
    phase lag where both are sinusoidal."""


NOTHING = OnePeriod(*7 * (math.nan,))


def correlation_lag(
    excitation: NDArray[np.float64], response: NDArray[np.float64], interval: float, longest: float
) -> tuple[float, float]:
    """Lag of a response at the best correlation with its excitation, s, and the correlation coefficient.

    `excitation`, `response`: equally spaced, zero outside, shape (n,); `interval`: between samples, s; `longest`:
    largest lag, s. The lag is interpolated by a parabola.
    """
    lags = correlation_lags(len(response), len(excitation)) * interval
    product = correlate(response, excitation) / math.sqrt(
        float(np.dot(excitation, excitation) * np.dot(response, response))
    )
    is_within = np.abs(lags) <= longest + 1e-9
    return interpolated_peak(lags[is_within], product[is_within])


def one_period(
    time: NDArray[np.float64], steering: NDArray[np.float64], values: NDArray[np.float64], longest: float = 0.9
) -> OnePeriod:
    """Measures of the response of one quantity to one period; all NaN where a signal is zero or not finite.

    `time`: equally spaced, s, shape (n,); `steering`, `values`: less their values before the period, shape (n,);
    `values` has the sign of the steering in the steady state; `longest`: largest lag, s; less than half of the period.
    """
    if len(time) < 5 or not np.isfinite(values).all() or not values.any() or not steering.any():
        return NOTHING
    lag, correlation = correlation_lag(steering, values, float(time[1] - time[0]), longest)
    side = math.copysign(1.0, float(steering[np.flatnonzero(np.abs(steering) > 0.5 * np.abs(steering).max())[0]]))
    lags, ratios = [], []
    for direction in (side, -side):
        peak_time, peak = interpolated_peak(time, direction * steering)
        is_near = (time >= peak_time - 0.1 * longest) & (time <= peak_time + longest)
        response_time, response_peak = interpolated_peak(time[is_near], direction * values[is_near])
        lags.append(response_time - peak_time)
        ratios.append(response_peak / peak)
    area = 0.5 * abs(float(np.sum(steering[:-1] * values[1:] - steering[1:] * values[:-1])))
    ellipse = math.pi * 0.25 * float(np.ptp(steering) * np.ptp(values))
    return OnePeriod(lag, correlation, lags[0], lags[1], ratios[0], ratios[1], area / ellipse)
