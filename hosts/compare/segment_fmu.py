"""An FMU that drives segments of a log."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any, TypeAlias

from hosts.common.numbers import Value
from hosts.compare.measured_speed import make_speed_holder
from hosts.compare.segments import Segment
from hosts.driving.co_simulation import run
from hosts.driving.result import Result
from hosts.fmu.fmu import StartRefusedError
from hosts.fmu.fmu_source import FmuSource, LoadedFmu

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
        driver = None if segment.speed is None else make_speed_holder(segment.speed, segment.pedal, self._step)
        return run(self.fresh(), manoeuvre, self._step, driver, progress)
