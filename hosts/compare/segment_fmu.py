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

_GAINS = 4.0, 4.0  # pedal per m/s and per m; for accuracy, not comfort
_ACCELERATION_GAIN = 0.1  # pedal per m/s2
_FINE = 0.01  # s: longest communication step of these gains; with longer ones a car of 10 m/s2 would oscillate

SLIDING = 0.05
"""Slip of an axle from which on the driver eases the throttle."""

_SMOOTHED = 0.2  # s
_PARABOLA = 2  # degree
_UNEVEN_INTERVAL = 0.5  # of the time between samples


def smoothed(speed: Signal) -> Signal:
    """The speed smoothed by parabolas over 0.2 s, which reduces the noise of the acceleration feedforward.

    Stretches between gaps are smoothed separately; short ones and those of uneven samples are not smoothed.
    """
    if len(speed.values) < _PARABOLA + 2:
        return speed
    window, values = 2 * round(0.5 * _SMOOTHED / speed.interval) + 1, speed.values.copy()
    intervals = np.diff(speed.time)
    uneven = np.flatnonzero(np.abs(intervals - speed.interval) > _UNEVEN_INTERVAL * speed.interval) + 1
    for indices in np.split(np.arange(len(values)), uneven):
        if len(indices) >= window > _PARABOLA + 1:
            values[indices] = savgol_filter(speed.values[indices], window, _PARABOLA)
    return replace(speed, values=values)


def _speed_holder(speed: Signal, pedal: float, step: float) -> SpeedHolder:
    speed = smoothed(speed)
    proportional, integral = (gain * min(1.0, _FINE / step) for gain in _GAINS)

    def target_speed(t: float) -> float:
        return float(np.interp(t, speed.time, speed.values))

    return SpeedHolder(target_speed, proportional, integral, _ACCELERATION_GAIN, pedal=pedal, sliding=SLIDING)


Task: TypeAlias = tuple[int, dict[str, Value], bool | None]
"""Number of a segment, start values by our names, and `SegmentFmu.can_reset`."""


class SegmentFmu(LoadedFmu):
    """An FMU that drives segments of a log.

    `step`: communication step, s; `segments`: by the numbers of tasks. `can_reset`: whether a reset reproduces a run;
    else the FMU is loaded again for each drive. None: not known.
    """

    def __init__(self, source: FmuSource, step: float, segments: Sequence[Segment] = ()) -> None:
        super().__init__(source)
        self._step, self._segments = step, list(segments)
        self.can_reset: bool | None = None

    def __call__(self, task: Task, tell: Callable[[Any], None]) -> Result | str:
        """Drive the segment of a task. Returns a sentence where the FMU refuses the start values."""
        number, values, self.can_reset = task
        try:
            total = len(self._segments) * self._segments[number].length / self._step
            return self.drive(self._segments[number], values, lambda done: tell(done / total))
        except StartRefusedError as error:
            return str(error)

    def drive(
        self,
        segment: Segment,
        values: Mapping[str, Value] | None = None,
        progress: Callable[[int], None] = lambda done: None,
    ) -> Result:
        """Drive one segment. `values`: start values by our names, in place of those of the segment."""
        if self.can_reset is False:
            self.close()
        manoeuvre = replace(segment.manoeuvre, start={**segment.manoeuvre.start, **(values or {})})
        # A pilot has a state: each run has its own.
        driver = None if segment.speed is None else _speed_holder(segment.speed, segment.pedal, self._step)
        return run(self.fresh(), manoeuvre, self._step, driver, progress)
