"""Measures of a run with sine with dwell steering: begin and completion of steer, yaw rate ratios, displacement."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import cumulative_trapezoid, trapezoid

from hosts.measures.filters import crossing

BEGIN = math.radians(5.0)
"""Steering-wheel angle at the begin of steer, rad."""


@dataclass(frozen=True)
class SineWithDwell:
    """Measures of a run; NaN where the record ends before."""

    begin: float
    completion: float
    """`begin`, `completion`: begin and completion of steer (BOS, COS), s."""
    ratio_1_00: float
    ratio_1_75: float
    """`ratio_1_00`, `ratio_1_75`: yaw rate 1.00 and 1.75 s after the completion over its second peak, the first one
    after the steering reversal; negative: the yaw rate has changed its sign."""
    displacement: float
    """Absolute lateral displacement 1.07 s after the begin, m."""
    sideslip: float
    """Largest absolute sideslip angle until 1.75 s after the completion, rad; NaN without the signal."""


NOTHING = SineWithDwell(*6 * (math.nan,))


def sine_with_dwell(
    time: NDArray[np.float64],
    steering: NDArray[np.float64],
    yaw_rate: NDArray[np.float64],
    acceleration: NDArray[np.float64],
    sideslip: NDArray[np.float64] | None = None,
) -> SineWithDwell:
    """Measures of a run.

    `time`: in s, shape (n,); `steering`, `yaw_rate`, `acceleration`: in rad, rad/s, m/s², shape (n,): filtered, with a
    mean of zero before the steering; the acceleration is that of the centre of mass, lateral and in the plane of the
    road; `sideslip`: in rad, shape (n,).

    Notes
    -----
    The displacement is the double integral of the lateral acceleration from the begin of steer, as in the regulation;
    it differs from that of the path, since the acceleration includes speed times yaw rate.
    """
    side = _steering_side(steering)
    begin = crossing(time, side * steering, BEGIN)
    reversal = crossing(time, side * steering, 0.0, begin)
    completion = _completion(time, side * steering, reversal)
    if not math.isfinite(completion):
        return NOTHING if not math.isfinite(begin) else _begin_and_displacement(begin, time, acceleration)
    peak = _peak(time, -side * yaw_rate, reversal)

    def yaw_rate_ratio(delay: float) -> float:
        t = completion + delay
        return -side * float(np.interp(t, time, yaw_rate)) / peak if t <= time[-1] + 1e-9 else math.nan

    largest = math.nan
    if sideslip is not None:
        window = (time >= begin) & (time <= completion + 1.75)
        largest = float(np.abs(sideslip[window]).max())
    first = _begin_and_displacement(begin, time, acceleration)
    return SineWithDwell(begin, completion, yaw_rate_ratio(1.0), yaw_rate_ratio(1.75), first.displacement, largest)


def _steering_side(steering: NDArray[np.float64]) -> float:
    """1 if the first half wave is to the left, -1 if to the right."""
    indices = np.flatnonzero(np.abs(steering) > 0.5 * np.abs(steering).max())
    return math.copysign(1.0, float(steering[indices[0]])) if len(indices) else 1.0


def _completion(time: NDArray[np.float64], steering: NDArray[np.float64], reversal: float) -> float:
    """Time at which the steering wheel returns to straight ahead after the dwell, s; NaN if it does not."""
    if not math.isfinite(reversal):
        return math.nan
    lowest = int(np.argmin(steering))
    # The filtered angle oscillates about zero after the end: below 1 % of the amplitude it is zero.
    return crossing(time, steering, 0.01 * float(steering[lowest]), max(reversal, float(time[lowest])))


def _peak(time: NDArray[np.float64], yaw_rate: NDArray[np.float64], begin: float) -> float:
    """First positive local maximum of the yaw rate after a time, s; the largest value where there is none."""
    values = yaw_rate[time >= begin]
    peaks = np.flatnonzero((values[1:-1] > values[:-2]) & (values[1:-1] >= values[2:]) & (values[1:-1] > 0.0)) + 1
    return float(values[peaks[0]]) if len(peaks) else float(values.max())


def _begin_and_displacement(
    begin: float, time: NDArray[np.float64], acceleration: NDArray[np.float64]
) -> SineWithDwell:
    """The measures with the begin of steer and the displacement only."""
    end = begin + 1.07
    if time[-1] < end - 1e-9:
        return SineWithDwell(begin, *5 * (math.nan,))
    inner = time[(time > begin) & (time < end)]
    t = np.concatenate([[begin], inner, [end]])
    velocity = np.asarray(cumulative_trapezoid(np.interp(t, time, acceleration), t, initial=0))
    displacement = float(trapezoid(velocity, t))
    return SineWithDwell(begin, *3 * (math.nan,), abs(displacement), math.nan)
