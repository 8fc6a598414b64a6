"""Replays a log as inputs of an FMU, once for each set of parameters."""

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager, nullcontext
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from ali3.isolated_processes import Lost
from hosts.common.closable import Closable
from hosts.common.errors import FailedFmuError
from hosts.common.numbers import Value
from hosts.compare.segment_fmu import SegmentFmu, Task
from hosts.compare.segments import Segment, join_results
from hosts.driving.manoeuvre import ON_TIME, Manoeuvre
from hosts.driving.result import Result
from hosts.experiment.experiment import Experiment, Progress
from hosts.fmu.fmu import StartRefusedError
from hosts.fmu.fmu_source import FmuSource
from hosts.fmu.own_process import files_of_drives
from hosts.measures.signal import Signal


def replay_manoeuvre(
    name: str,
    inputs: Mapping[str, Signal],
    start: Mapping[str, Value],
    end: float,
    step: float,
    hold_inputs: bool = False,
    integers: Collection[str] = (),
    follower_frequencies: Mapping[str, float] | None = None,
    held: Collection[str] = (),
) -> Manoeuvre:
    """The manoeuvre with the measured inputs of an FMU: a row for each step, and two at each jump of an input.

    Parameters
    ----------
    end : float
        Stop time, s.
    step : float
        Communication step, s.
    hold_inputs : bool
        Whether the FMU holds its inputs during a step. Each then has the measured value of the middle of the step, so
        that there is no mean delay; otherwise that of the beginning.
    integers : collection of str
        Integer inputs, which keep the value of a sample up to the next.
    follower_frequencies : mapping of str to float, optional
        Frequency of the follower, Hz, of each input whose follower moves as measured.
    held : collection of str
        Inputs and tunable parameters that keep the value of a sample up to the next.
    """
    steps = max(1, round(end / step))
    points = step * np.arange(steps + 1, dtype=np.float64)
    inputs = {n: replace(s, time=_snapped_to_points(s.time, step)) for n, s in inputs.items()}
    jumps = np.unique(np.concatenate([np.zeros(0), *(s.jumps for s in inputs.values())]))
    time = np.sort(np.concatenate((np.setdiff1d(points, jumps), jumps, jumps)))
    is_before_jump = np.append(np.diff(time) == 0.0, False)
    input_times = np.where(hold_inputs & np.isin(time, points) & ~is_before_jump, time + 0.5 * step, time)
    columns = {
        n: _held_values(s, time, is_before_jump, n in integers)
        if n in integers or n in held
        else _interpolate(s, input_times, is_before_jump)
        for n, s in inputs.items()
    }
    for n, frequency in (follower_frequencies or {}).items():
        columns[n] = follower_demand(inputs[n], frequency, input_times)
    return Manoeuvre(name, time, columns, steps * step, dict(start), held=frozenset(held))


def _snapped_to_points(time: NDArray[np.float64], step: float) -> NDArray[np.float64]:
    """Times, with those at communication points set to them exactly."""
    points = step * np.round(time / step)
    return np.where(np.abs(time - points) < ON_TIME, points, time)


def _interpolate(signal: Signal, time: NDArray[np.float64], is_before_jump: NDArray[np.bool_]) -> NDArray[np.float64]:
    after = np.interp(time, signal.time, signal.values)
    # Interpolated backwards in time, a jump has its earlier value.
    return np.where(is_before_jump, np.interp(-time, -signal.time[::-1], signal.values[::-1]), after)


def _held_values(
    signal: Signal, time: NDArray[np.float64], is_before_jump: NDArray[np.bool_], is_integer: bool
) -> NDArray[np.float64]:
    rows = (
        np.where(is_before_jump, np.searchsorted(signal.time, time), np.searchsorted(signal.time, time, side="right"))
        - 1
    )
    values = signal.values[np.maximum(rows, 0)]
    return np.asarray(np.round(values) if is_integer else values)


class Replay(Closable):
    """An FMU that is driven repeatedly with the same inputs.

    Parameters
    ----------
    step : float
        Communication step, s.
    segments : sequence of Segment
        Segments of the log, each with its own start values.
    jobs : int
        Number of processes that run the segments; results do not depend on it.

    Attributes
    ----------
    runs : int
        Number of runs so far.
    messages : dict of str to int
        Number of runs by the messages that the FMU logged at warning or above.
    """

    def __init__(self, fmu: FmuSource, segments: Sequence[Segment], step: float, jobs: int = 1) -> None:
        self.segments, self.step = list(segments), step
        reads = files_of_drives(fmu.path, (segment.manoeuvre.start for segment in segments))
        segment_fmu = SegmentFmu(fmu, step, segments)
        self._bar_text = "compare"
        self._experiment: Experiment[Task, Result | str] = Experiment(
            self._bar_text,
            segment_fmu,
            Result | str,
            lambda task: self._bar_text,
            reads,
            lambda task: 1.0 / len(self.segments),
        )
        self._pool = self._experiment.pool(min(jobs, len(segments)))
        self._progress: Progress[Task, Result | str] | None = None
        self._can_reset: bool | None = None
        self.messages: dict[str, int] = {}
        self.runs = 0

    def close(self) -> None:
        """End all processes."""
        self._pool.close()

    @contextmanager
    def one_progress_bar(self, text: str) -> Iterator[None]:
        """Show one progress bar, which counts, for all runs of the block. `text`: their purpose, on the bar."""
        self._bar_text = text
        with Progress(self._experiment) as self._progress:
            yield
        self._progress = None

    def run(self, values: Mapping[str, Value] | None = None) -> Result:
        """Drive all segments. `values`: start values by ALi3 names that replace those of the manoeuvres.

        Returns the result under ALi3 names; see `join_results` for several segments. Raises `FailedFmuError` if a
        process has ended, `StartRefusedError` if the FMU refuses the start values.
        """
        tasks: list[Task] = [(k, dict(values or {}), self._can_reset) for k in range(len(self.segments))]
        with Progress(self._experiment, 1.0) if self._progress is None else nullcontext(self._progress) as progress:
            by_task = {k: result for k, _, result in progress.results(tasks, self._pool)}
        results = [self._result(k, by_task[k]) for k in range(len(tasks))]
        self.runs += 1
        for message in dict.fromkeys(m for result in results for m in result.messages):
            self.messages[message] = self.messages.get(message, 0) + 1
        return results[0] if len(results) == 1 else join_results(results, self.segments)

    def check_reset(self) -> bool:
        """Check by two drives of the first segment whether a reset reproduces a run; otherwise each drive loads the
        FMU.

        Returns whether the FMU is reproducible to the last bit, by a reset or by loading it again.
        """
        for self._can_reset in (True, False):
            task: Task = (0, {}, self._can_reset)
            first, again = (self._result(0, self._pool.run(task)).values for _ in range(2))
            if first.shape == again.shape and bool(np.array_equal(first, again, equal_nan=True)):
                return True
        return False

    def _result(self, number: int, result: Result | str | Lost) -> Result:
        if isinstance(result, str):
            raise StartRefusedError(result)
        if not isinstance(result, Lost):
            return result
        hint = " --jobs 1 takes less memory." if len(self._pool) > 1 else ""
        begin = self.segments[number].begin
        raise FailedFmuError(f"The process that drove the window from {begin:g} s {result.how}.{hint}")


def follower_demand(signal: Signal, frequency: float, time: NDArray[np.float64]) -> NDArray[np.float64]:
    """The demand of a critically damped follower that moves as measured.

    `frequency`: frequency of the follower, Hz; `time`: s, shape (n,). Returns an array of shape (n,): x + 2 x' / w +
    x'' / w^2 with w = 2 pi frequency, of a cubic through the samples that has no extremes of its own. It begins with x,
    where the follower begins at rest; beyond the samples their ends are held.
    """
    w = 2.0 * math.pi * frequency
    x = PchipInterpolator(signal.time, signal.values)
    at = np.clip(time, signal.time[0], signal.time[-1])
    inside = (time > signal.time[0]) & (time < signal.time[-1])
    return np.asarray(x(at) + inside * (2.0 / w * x(at, 1) + x(at, 2) / w**2))
