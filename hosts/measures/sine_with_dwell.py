"""Measures of runs with slowly increasing steer and with sine-with-dwell steering."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import cumulative_trapezoid, trapezoid

from hosts.measures.filters import crossing, first_direction

_BEGINNING_ANGLE = math.radians(5.0)  # rad, S7.11.5 of 49 CFR 571.126
_DISPLACEMENT_DELAY = 1.07  # s, S5.2.3
_ROUND_OFF = 1e-9  # s
G = 9.80665  # m/s2
_TARGET = 0.3 * G
_MIN_ACCELERATION = 0.1 * G
_MAX_ACCELERATION = 0.375 * G


@dataclass(frozen=True)
class SineWithDwell:
    """Measures of a run; NaN if the record is too short."""

    beginning: float = math.nan
    """Beginning of steer (BOS), s."""
    completion: float = math.nan
    """Completion of steer (COS), s."""
    yaw_rate_ratio_1_00: float = math.nan
    """Yaw rate 1.00 s after completion of steer, relative to its first peak after the steering reversal; negative: the
    yaw rate has changed its sign."""
    yaw_rate_ratio_1_75: float = math.nan
    """Likewise 1.75 s after completion of steer."""
    displacement: float = math.nan
    """Absolute lateral displacement 1.07 s after beginning of steer, m."""
    sideslip: float = math.nan
    """Largest absolute sideslip angle until 1.75 s after completion of steer, rad; NaN without the signal."""


def measure_sine_with_dwell(
    time: NDArray[np.float64],
    steering: NDArray[np.float64],
    yaw_rate: NDArray[np.float64],
    lateral_acceleration: NDArray[np.float64],
    sideslip: NDArray[np.float64] | None = None,
) -> SineWithDwell:
    """Measure a run with sine-with-dwell steering.

    `time`: times, s, shape (n,); `steering`, `yaw_rate`, `lateral_acceleration`: signals in rad, rad/s, m/s², shape
    (n,), filtered, with a mean of zero before the steering; acceleration of the centre of mass in the plane of the
    road; `sideslip`: sideslip angle, rad, shape (n,).

    Notes
    -----
    The displacement is the double integral of the lateral acceleration from beginning of steer, as in the regulation;
    it differs from the displacement of the path, since the acceleration includes speed times yaw rate.
    """
    direction = first_direction(steering)
    beginning = crossing(time, direction * steering, _BEGINNING_ANGLE)
    if not math.isfinite(beginning):
        return SineWithDwell()
    displacement = _displacement(beginning, time, lateral_acceleration)
    reversal = crossing(time, direction * steering, 0.0, beginning)
    completion = _completion(time, direction * steering, reversal)
    if not math.isfinite(completion):
        return SineWithDwell(beginning=beginning, displacement=displacement)
    response = -direction * yaw_rate
    peak = _peak(time, response, reversal) or math.nan  # without a response there are no ratios
    max_sideslip = math.nan
    if sideslip is not None:
        window = (time >= beginning) & (time <= completion + 1.75)
        max_sideslip = float(np.abs(sideslip[window]).max())
    return SineWithDwell(
        beginning=beginning,
        completion=completion,
        yaw_rate_ratio_1_00=_value_at(completion + 1.0, time, response) / peak,
        yaw_rate_ratio_1_75=_value_at(completion + 1.75, time, response) / peak,
        displacement=displacement,
        sideslip=max_sideslip,
    )


def _value_at(t: float, time: NDArray[np.float64], values: NDArray[np.float64]) -> float:
    """Value of a signal at a time, s; NaN after its end."""
    return float(np.interp(t, time, values)) if t <= time[-1] + _ROUND_OFF else math.nan


def _completion(time: NDArray[np.float64], steering: NDArray[np.float64], reversal: float) -> float:
    """Time at which the steering wheel returns to straight ahead after the dwell, s; NaN if it does not."""
    if not math.isfinite(reversal):
        return math.nan
    second_peak = int(np.argmin(steering))
    # The filtered angle oscillates about zero after the end: below 1 % of the amplitude it is zero.
    return crossing(time, steering, 0.01 * float(steering[second_peak]), max(reversal, float(time[second_peak])))


def _peak(time: NDArray[np.float64], yaw_rate: NDArray[np.float64], start: float) -> float:
    """First positive local maximum of the yaw rate after a time, s; the largest value if there is none."""
    values = yaw_rate[time >= start]
    peaks = np.flatnonzero((values[1:-1] > values[:-2]) & (values[1:-1] >= values[2:]) & (values[1:-1] > 0.0)) + 1
    return float(values[peaks[0]]) if len(peaks) else float(values.max())


def _displacement(beginning: float, time: NDArray[np.float64], acceleration: NDArray[np.float64]) -> float:
    """Absolute double integral of the acceleration from beginning of steer, m; NaN if the record is too short."""
    end = beginning + _DISPLACEMENT_DELAY
    if time[-1] < end - _ROUND_OFF:
        return math.nan
    inner = time[(time > beginning) & (time < end)]
    t = np.concatenate([[beginning], inner, [end]])
    velocity = np.asarray(cumulative_trapezoid(np.interp(t, time, acceleration), t, initial=0))
    return abs(float(trapezoid(velocity, t)))


def angle_by_regression(steering: NDArray[np.float64], acceleration: NDArray[np.float64]) -> float:
    """Absolute angle at a lateral acceleration of 0.3 g, rad, by a regression line from 0.1 g to 0.375 g.

    `steering`, `acceleration`: rad and m/s², of a turn to one side, shape (n,). NaN if 0.375 g is not reached.
    """
    lateral = np.abs(acceleration)
    if not (lateral >= _MAX_ACCELERATION).any():
        return math.nan
    last = int(np.argmax(lateral >= _MAX_ACCELERATION))
    first = int(np.argmax(lateral >= _MIN_ACCELERATION))
    if last - first < 3:
        return math.nan
    line = np.polyfit(lateral[first:last], np.abs(steering[first:last]), 1)
    return float(np.polyval(line, _TARGET))
