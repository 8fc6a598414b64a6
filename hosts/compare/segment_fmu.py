"""An FMU that drives segments of a log."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any, TypeAlias

import numpy as np
from scipy.signal import savgol_filter

from hosts.common.numbers import Value
from hosts.compare.segments import Segment
from hosts.driving.co_simulation import run
from hosts.driving.pilots.speed_holder import SpeedHolder
from hosts.driving.result import Result
from hosts.fmu.fmu import StartRefusedError
from hosts.fmu.fmu_source import FmuSource, LoadedFmu
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


def _make_speed_holder(speed: Signal, pedal: float, step: float) -> SpeedHolder:
    speed = smooth_speed(speed)
    proportional, integral = (gain * min(1.0, _MAX_STEP / step) for gain in (_PROPORTIONAL_GAIN, _INTEGRAL_GAIN))

    def target_speed(t: float) -> float:
        return float(np.interp(t, speed.time, speed.values))

    return SpeedHolder(target_speed, proportional, integral, _ACCELERATION_GAIN, pedal=pedal, sliding=SLIP_LIMIT)


Task: TypeAlias = tuple[int, dict[str, Value], bool | None]
"""Index of a segment, start values by ALi3 names, and `SegmentFmu.can_reset`."""


class SegmentFmu(LoadedFmu):
    """Drives segments, as a task of a worker pool.

    `step`: communication step, s; `segments`: a task names one by its index. `can_reset`: whether a reset reproduces a
    run; otherwise the FMU is loaded again for each run. None: unknown.
    """

    def __init__(self, source: FmuSource, step: float, segments: Sequence[Segment] = ()) -> None:
        super().__init__(source)
        self._step, self._segments = step, list(segments)
        self.can_reset: bool | None = None

    def __call__(self, task: Task, report_progress: Callable[[Any], None]) -> Result | str:
        """Drive the segment of a task. Returns a sentence if the FMU refuses the start values."""
        index, values, self.can_reset = task
        try:
            # The fraction done of all segments, as if they were equally long.
            steps = len(self._segments) * self._segments[index].length / self._step
            return self.drive(self._segments[index], values, lambda done: report_progress(done / steps))
        except StartRefusedError as error:
            return str(error)

    def drive(
        self,
        segment: Segment,
        values: Mapping[str, Value] | None = None,
        progress: Callable[[int], None] = lambda done: None,
    ) -> Result:
        """Drive one segment. `values`: start values by ALi3 names that replace those of the segment."""
        if self.can_reset is False:
            self.close()
        manoeuvre = replace(segment.manoeuvre, start={**segment.manoeuvre.start, **(values or {})})
        # A pilot has a state: each run has its own.
        driver = None if segment.speed is None else _make_speed_holder(segment.speed, segment.pedal, self._step)
        return run(self.fresh(), manoeuvre, self._step, driver, progress)
