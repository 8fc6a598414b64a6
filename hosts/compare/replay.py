"""Replays a log as inputs of an FMU, as often as parameters are tried."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager, nullcontext
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ali3.isolated_processes import Lost
from hosts.common.closable import Closable
from hosts.common.errors import FailedFmuError
from hosts.common.numbers import Value
from hosts.compare.follower_demand import demanded
from hosts.compare.segment_fmu import SegmentFmu, Task
from hosts.compare.segments import Segment, joined
from hosts.driving.manoeuvre import ON_TIME, Manoeuvre
from hosts.driving.result import Result
from hosts.experiment.experiment import Experiment, Progress
from hosts.fmu.fmu import StartRefusedError
from hosts.fmu.fmu_source import FmuSource
from hosts.fmu.own_process import files_of_drives
from hosts.measures.signal import Signal


def inputs_of(
    name: str,
    inputs: Mapping[str, Signal],
    start: Mapping[str, Value],
    end: float,
    step: float,
    held: bool = False,
    whole: Collection[str] = (),
    followed: Mapping[str, float] | None = None,
    kept: Collection[str] = (),
) -> Manoeuvre:
    """The manoeuvre that gives an FMU the measured inputs, with a row a step and two where an input jumps.

    Parameters
    ----------
    end : float
        s.
    step : float
        Communication step, s.
    held : bool
        Whether the FMU holds its inputs during a step. Each then has the measured value of the middle of the step, so
        that on the whole nothing is late; else that of the beginning.
    whole : collection of str
        Inputs that are whole numbers, which keep the value of a sample up to the next.
    followed : mapping of str to float, optional
        Inputs that the car follows, by the frequency of its follower in Hz: the measured signal is what follows.
    kept : collection of str
        Inputs and tunable parameters that keep the value of a sample up to the next.
    """
    steps = max(1, round(end / step))
    points = step * np.arange(steps + 1, dtype=np.float64)
    inputs = {n: replace(s, time=_on_points(s.time, step)) for n, s in inputs.items()}
    jumps = np.unique(np.concatenate([np.zeros(0), *(s.jumps for s in inputs.values())]))
    time = np.sort(np.concatenate((np.setdiff1d(points, jumps), jumps, jumps)))
    before = np.append(np.diff(time) == 0.0, False)
    at = np.where(held & np.isin(time, points) & ~before, time + 0.5 * step, time)
    columns = {
        n: _kept(s, time, before, n in whole) if n in whole or n in kept else _straight(s, at, before)
        for n, s in inputs.items()
    }
    for n, frequency in (followed or {}).items():
        columns[n] = demanded(inputs[n], frequency, at)
    return Manoeuvre(name, time, columns, steps * step, dict(start), held=frozenset(kept))


def _on_points(time: NDArray[np.float64], step: float) -> NDArray[np.float64]:
    """Times with those that are meant to be communication points there to the last digit."""
    point = step * np.round(time / step)
    return np.where(np.abs(time - point) < ON_TIME, point, time)


def _straight(signal: Signal, time: NDArray[np.float64], before: NDArray[np.bool_]) -> NDArray[np.float64]:
    behind = np.interp(time, signal.time, signal.values)
    # Backwards in time the value before a jump is the one behind it.
    return np.where(before, np.interp(-time, -signal.time[::-1], signal.values[::-1]), behind)


def _kept(signal: Signal, time: NDArray[np.float64], before: NDArray[np.bool_], whole: bool) -> NDArray[np.float64]:
    rows = np.where(before, np.searchsorted(signal.time, time), np.searchsorted(signal.time, time, side="right")) - 1
    values = signal.values[np.maximum(rows, 0)]
    return np.asarray(np.round(values) if whole else values)


class Replay(Closable):
    """An FMU that is driven again and again through the same inputs.

    Parameters
    ----------
    step : float
        Communication step, s.
    segments : sequence of Segment
        Windows that are driven one after the other, each from its start.
    jobs : int
        Processes that share the segments; what they give does not depend on their number.

    Attributes
    ----------
    runs : int
        That were made.
    said : dict of str to int
        What the FMU logged at warning or above, and in how many runs.
    """

    def __init__(
        self,
        fmu: FmuSource,
        segments: Sequence[Segment],
        step: float,
        jobs: int = 1,
    ) -> None:
        self.segments, self.step = list(segments), step
        reads = files_of_drives(fmu.path, (segment.manoeuvre.start for segment in segments))
        work = SegmentFmu(fmu, step, segments)
        self._does = "compare"
        self._experiment: Experiment[Task, Result | str] = Experiment(
            self._does, work, Result | str, lambda task: self._does, reads, lambda task: 1.0 / len(self.segments)
        )
        self._pool = self._experiment.pool(min(jobs, len(segments)))
        self._shown: Progress[Task, Result | str] | None = None
        self._can_reset: bool | None = None
        self.said: dict[str, int] = {}
        self.runs = 0

    def close(self) -> None:
        """End all processes."""
        self._pool.close()

    @contextmanager
    def searching(self, does: str) -> Iterator[None]:
        """Runs of the block stand under one bar, which counts them. `does`: what they are for, on the bar."""
        self._does = does
        with Progress(self._experiment) as self._shown:
            yield
        self._shown = None

    def run(self, values: Mapping[str, Value] | None = None) -> Result:
        """Drive all segments with other start values than those of their manoeuvres. `values`: by our names.

        Result: under our names; several segments as `joined` puts them. Raises `FailedFmuError`: a process has ended.
        """
        tasks: list[Task] = [(k, dict(values or {}), self._can_reset) for k in range(len(self.segments))]
        with Progress(self._experiment, 1.0) if self._shown is None else nullcontext(self._shown) as progress:
            by_task = {k: result for k, _, result in progress.results(tasks, self._pool)}
        results = [self._result(k, by_task[k]) for k in range(len(tasks))]
        self.runs += 1
        for message in dict.fromkeys(m for result in results for m in result.messages):
            self.said[message] = self.said.get(message, 0) + 1
        return results[0] if len(results) == 1 else joined(results, self.segments)

    def check_reset(self) -> bool:
        """Drive the first segment twice; an FMU that does not repeat itself is loaded again for each drive from now on.

        Returns whether it repeats itself to the last bit, after a reset or loaded again.
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
        fewer = " --jobs 1 takes less memory." if len(self._pool) > 1 else ""
        begin = self.segments[number].begin
        raise FailedFmuError(f"The process that drove the window from {begin:g} s {result.how}.{fewer}")
