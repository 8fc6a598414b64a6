"""The driver that holds a measured speed, and the smoothing of that speed."""

from dataclasses import replace

import numpy as np
from scipy.signal import savgol_filter

from hosts.driving.pilots.speed_holder import SpeedHolder
from hosts.measures.signal import Signal

_PROPORTIONAL_GAIN = 4.0  # pedal per m/s; for accuracy, not comfort
_INTEGRAL_GAIN = 4.0  # pedal per m
_ACCELERATION_GAIN = 0.1  # pedal per m/s2
_MAX_STEP = 0.01  # s: longest communication step at which a car of 10 m/s2 does not oscillate with these gains

SLIP_LIMIT = 0.05
"""Slip of an axle above which the driver reduces the throttle."""

_WINDOW = 0.2  # s
_DEGREE = 2
_GAP = 0.5  # deviation of an interval that counts as a gap, of the mean interval


def smooth_speed(speed: Signal) -> Signal:
    """Smooth a speed by a Savitzky-Golay filter, which reduces the noise of the acceleration feedforward.

    Stretches between gaps are smoothed separately; those shorter than the window are not smoothed.
    """
    if len(speed.values) < _DEGREE + 2:
        return speed
    window = 2 * round(0.5 * _WINDOW / speed.interval) + 1
    values = speed.values.copy()
    intervals = np.diff(speed.time)
    gaps = np.flatnonzero(np.abs(intervals - speed.interval) > _GAP * speed.interval) + 1
    for indices in np.split(np.arange(len(values)), gaps):
        if len(indices) >= window > _DEGREE + 1:
            values[indices] = savgol_filter(speed.values[indices], window, _DEGREE)
    return replace(speed, values=values)


def make_speed_holder(speed: Signal, pedal: float, step: float) -> SpeedHolder:
    """A driver of a measured speed, smoothed. `pedal`: at the start, negative: brake; `step`: communication step, s."""
    speed = smooth_speed(speed)
    proportional, integral = (gain * min(1.0, _MAX_STEP / step) for gain in (_PROPORTIONAL_GAIN, _INTEGRAL_GAIN))

    def target_speed(t: float) -> float:
        return float(np.interp(t, speed.time, speed.values))

    return SpeedHolder(target_speed, proportional, integral, _ACCELERATION_GAIN, pedal=pedal, sliding=SLIP_LIMIT)
