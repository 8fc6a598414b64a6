"""One period of sinusoidal steering: delay, gain and hysteresis of the response."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import correlate, correlation_lags

from hosts.measures.filters import first_direction, interpolated_peak

_ROUND_OFF = 1e-9  # s


@dataclass(frozen=True)
class SinusoidalResponse:
    """Measures of the response of one quantity to one period of sinusoidal steering; NaN by default."""

    correlation_lag: float = math.nan
    """Lag at the best correlation with the steering, s; positive: behind the steering."""
    correlation: float = math.nan
    """Correlation coefficient at that lag, -1 to 1."""
    first_lag: float = math.nan
    """Lag of its first peak behind the first peak of the steering, s."""
    second_lag: float = math.nan
    """Lag of its second peak behind the second peak of the steering, s."""
    first_ratio: float = math.nan
    """Ratio of its first peak to the first peak of the steering, in the unit of the quantity per rad."""
    second_ratio: float = math.nan
    """Ratio of its second peak to the second peak of the steering, in the unit of the quantity per rad."""
    hysteresis: float = math.nan
    """Area of its loop over the steering angle, relative to the ellipse in the bounding rectangle of the loop; the sine
    of the phase lag if both are sinusoidal."""


def correlation_lag(
    excitation: NDArray[np.float64], response: NDArray[np.float64], interval: float, max_lag: float
) -> tuple[float, float]:
    """Lag of a response at the best correlation with its excitation, s, and the correlation coefficient.

    `excitation`, `response`: equally spaced samples, zero outside, shape (n,); `interval`: time between samples, s;
    `max_lag`: largest lag, s. The lag is interpolated by a parabola.
    """
    lags = correlation_lags(len(response), len(excitation)) * interval
    product = correlate(response, excitation) / math.sqrt(
        float(np.dot(excitation, excitation) * np.dot(response, response))
    )
    is_within = np.abs(lags) <= max_lag + _ROUND_OFF
    return interpolated_peak(lags[is_within], product[is_within])


def measure_response(
    time: NDArray[np.float64], steering: NDArray[np.float64], values: NDArray[np.float64], max_lag: float
) -> SinusoidalResponse:
    """Measure the response of one quantity to one period; all NaN if a signal is zero or `values` are not finite.

    `time`: equally spaced, s, shape (n,); `steering`, `values`: signals minus their values before the period, shape
    (n,), steering in rad; `values`: positive for positive steering in the steady state; `max_lag`: largest lag, s, less
    than half of the period.
    """
    if len(time) < 5 or not np.isfinite(values).all() or not values.any() or not steering.any():
        return SinusoidalResponse()
    lag, correlation = correlation_lag(steering, values, float(time[1] - time[0]), max_lag)
    direction = first_direction(steering)
    lags, ratios = [], []
    for sign in (direction, -direction):
        peak_time, peak = interpolated_peak(time, sign * steering)
        # A response may lead the steering slightly.
        is_near = (time >= peak_time - 0.1 * max_lag) & (time <= peak_time + max_lag)
        response_time, response_peak = interpolated_peak(time[is_near], sign * values[is_near])
        lags.append(response_time - peak_time)
        ratios.append(response_peak / peak)
    # Shoelace formula; the loop is closed, as both signals end at zero.
    area = 0.5 * abs(float(np.sum(steering[:-1] * values[1:] - steering[1:] * values[:-1])))
    ellipse = math.pi * 0.25 * float(np.ptp(steering) * np.ptp(values))
    return SinusoidalResponse(
        correlation_lag=lag,
        correlation=correlation,
        first_lag=lags[0],
        second_lag=lags[1],
        first_ratio=ratios[0],
        second_ratio=ratios[1],
        hysteresis=area / ellipse,
    )
