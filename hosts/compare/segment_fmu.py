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

_GAINS = 4.0, 4.0  # pedal per m/s and per m: the speed is to be as measured, not comfortable
_ACCELERATION_GAIN = 0.1  # pedal per m/s2
_FINE = 0.01  # s: communication step up to which they hold; with longer ones a car of 10 m/s2 would swing

SLIDING = 0.05
"""Slip of an axle from which on the driver eases the throttle: no driver holds a speed against wheels that slide."""

_SMOOTHED = 0.2  # s
_PARABOLA = 2  # degree
_UNEVEN = 0.5  # of the time between samples


def smoothed(speed: Signal) -> Signal:
    """By parabolas over 0.2 s: the acceleration that a driver feeds forward is else mostly the noise of samples.

    Parts between gaps are smoothed each for itself, short ones and those of uneven samples are left as they are.
    """
    if len(speed.values) < _PARABOLA + 2:
        return speed
    window, values = 2 * round(0.5 * _SMOOTHED / speed.interval) + 1, speed.values.copy()
    intervals = np.diff(speed.time)
    uneven = np.flatnonzero(np.abs(intervals - speed.interval) > _UNEVEN * speed.interval) + 1
    for indices in np.split(np.arange(len(values)), uneven):
        if len(indices) >= window > _PARABOLA + 1:
            values[indices] = savgol_filter(speed.values[indices], window, _PARABOLA)
    return replace(speed, values=values)


def _holder(speed: Signal, pedal: float, step: float) -> SpeedHolder:
    speed = smoothed(speed)
    proportional, integral = (gain * min(1.0, _FINE / step) for gain in _GAINS)

    def wanted(t: float) -> float:
        return float(np.interp(t, speed.time, speed.values))

    return SpeedHolder(wanted, proportional, integral, _ACCELERATION_GAIN, pedal=pedal, sliding=SLIDING)


Task: TypeAlias = tuple[int, dict[str, Value], bool | None]
"""Number of a segment, start values by our names, and `SegmentFmu.can_reset`."""


class SegmentFmu(LoadedFmu):
    """An FMU that drives segments of a log.

    `step`: communication step, s; `segments`: those of the numbers of tasks. `can_reset`: whether it repeats itself
    after a reset; else it is loaded again for each drive. None: not known.
    """

    def __init__(self, source: FmuSource, step: float, segments: Sequence[Segment] = ()) -> None:
        super().__init__(source)
        self._step, self._stretches = step, list(segments)
        self.can_reset: bool | None = None

    def __call__(self, task: Task, tell: Callable[[Any], None]) -> Result | str:
        """The result, or why the FMU does not start with these values: no error, which would end the others."""
        number, values, self.can_reset = task
        try:
            total = len(self._stretches) * self._stretches[number].end / self._step
            return self.drive(self._stretches[number], values, lambda done: tell(done / total))
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
        # A pilot has a memory: each run has its own.
        driver = None if segment.speed is None else _holder(segment.speed, segment.pedal, self._step)
        return run(self.fresh(), manoeuvre, self._step, driver, progress)
