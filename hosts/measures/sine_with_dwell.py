"""Numbers of one run with sine with dwell steering: begin and end of steering, yaw rates after it, displacement."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import cumulative_trapezoid, trapezoid

from hosts.measures.filters import crossing

BEGIN = math.radians(5.0)
"""Angle of the steering wheel at which the steering has begun."""


@dataclass(frozen=True)
class SineWithDwell:
    """What is measured of one run; NaN where the record ends before it."""

    begin: float
    completion: float
    """`begin`, `completion`: begin and completion of steer (BOS, COS), s."""
    ratio_1_00: float
    ratio_1_75: float
    """`ratio_1_00`, `ratio_1_75`: yaw rate 1.00 and 1.75 s after the completion over its second peak, the first after
    the steering wheel has changed the side; negative: the yaw rate has changed its sign."""
    displacement: float
    """Size of the lateral displacement 1.07 s after the beginning, m."""
    sideslip: float
    """Largest size of the sideslip angle until 1.75 s after the completion, rad; NaN without the signal."""


NOTHING = SineWithDwell(*6 * (math.nan,))


def sine_with_dwell(
    time: NDArray[np.float64],
    steering: NDArray[np.float64],
    yaw_rate: NDArray[np.float64],
    acceleration: NDArray[np.float64],
    sideslip: NDArray[np.float64] | None = None,
) -> SineWithDwell:
    """Measures of one run.

    `time`: in s, shape (n,); `steering`, `yaw_rate`, `acceleration`: in rad, rad/s, m/s², shape (n,): filtered, and
    zero in the mean before the steering; the acceleration is that of the centre of mass, lateral and in the plane of
    the road; `sideslip`: in rad, shape (n,).

    Notes
    -----
    The displacement is the double integral of the lateral acceleration from the start, as the regulation has it. It is
    not that of the path, from which it differs by the turn of the car: it does not take away v times the yaw rate.
    """
    side = _side(steering)
    begin = crossing(time, side * steering, BEGIN)
    reversal = crossing(time, side * steering, 0.0, begin)
    completion = _completion(time, side * steering, reversal)
    if not math.isfinite(completion):
        return NOTHING if not math.isfinite(begin) else _of(begin, time, acceleration)
    peak = _peak(time, -side * yaw_rate, reversal)

    def after(seconds: float) -> float:
        at = completion + seconds
        return -side * float(np.interp(at, time, yaw_rate)) / peak if at <= time[-1] + 1e-9 else math.nan

    largest = math.nan
    if sideslip is not None:
        window = (time >= begin) & (time <= completion + 1.75)
        largest = float(np.abs(sideslip[window]).max())
    first = _of(begin, time, acceleration)
    return SineWithDwell(begin, completion, after(1.0), after(1.75), first.displacement, largest)


def _side(steering: NDArray[np.float64]) -> float:
    """1 if the first half is to the left, -1 if to the right."""
    indices = np.flatnonzero(np.abs(steering) > 0.5 * np.abs(steering).max())
    return math.copysign(1.0, float(steering[indices[0]])) if len(indices) else 1.0


def _completion(time: NDArray[np.float64], steering: NDArray[np.float64], reversal: float) -> float:
    """When the steering wheel comes back to straight, after the dwell on the other side."""
    if not math.isfinite(reversal):
        return math.nan
    lowest = int(np.argmin(steering))
    # the filter swings about zero after the end; below 1 % of the amplitude it is straight
    return crossing(time, steering, 0.01 * float(steering[lowest]), max(reversal, float(time[lowest])))


def _peak(time: NDArray[np.float64], yaw_rate: NDArray[np.float64], begin: float) -> float:
    """First local maximum of a yaw rate above zero after the reversal; the largest value where there is none."""
    rates = yaw_rate[time >= begin]
    peaks = np.flatnonzero((rates[1:-1] > rates[:-2]) & (rates[1:-1] >= rates[2:]) & (rates[1:-1] > 0.0)) + 1
    return float(rates[peaks[0]]) if len(peaks) else float(rates.max())


def _of(begin: float, time: NDArray[np.float64], acceleration: NDArray[np.float64]) -> SineWithDwell:
    """The start of the steering and the displacement alone."""
    at = begin + 1.07
    if time[-1] < at - 1e-9:
        return SineWithDwell(begin, *5 * (math.nan,))
    inner = time[(time > begin) & (time < at)]
    t = np.concatenate([[begin], inner, [at]])
    velocity = np.asarray(cumulative_trapezoid(np.interp(t, time, acceleration), t, initial=0))
    moved = float(trapezoid(velocity, t))
    return SineWithDwell(begin, *3 * (math.nan,), abs(moved), math.nan)
