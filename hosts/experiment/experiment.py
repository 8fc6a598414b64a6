"""Runs of an experiment, made by processes and shown on one progress bar."""

import math
import sys
from collections.abc import Callable, Generator, Iterable
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Generic, Protocol, TypeVar

from ali3.bars import bar as bar_of
from ali3.isolated_processes import Lost, Tell
from hosts.common.closable import Closable
from hosts.experiment.pool import Pool
from hosts.fmu.own_process import PATIENCE

_BAR_FORMAT = "{desc} {percentage:3.0f} % {bar} {elapsed} so far, {remaining} to go"
_COUNTING_BAR_FORMAT = "{desc} {n:.0f} done, {elapsed} so far"

T = TypeVar("T")
R = TypeVar("R")
T_contra = TypeVar("T_contra", contravariant=True)
R_co = TypeVar("R_co", covariant=True)


class Runner(Protocol[T_contra, R_co]):
    """The interface of what makes runs: processes of this machine (`Pool`), or workers of Dask (`ClusterRuns`)."""

    @property
    def left(self) -> int:
        """Number of processes that the runs had started and that were ended with them."""

    def results(
        self, tasks: Iterable[T_contra], told: Callable[[int, Any], None]
    ) -> Generator[tuple[int, R_co | Lost]]:
        """See `Pool.results`."""

    def close(self) -> None:
        """End all running tasks."""


@dataclass(frozen=True)
class Experiment(Generic[T, R]):
    """The function that performs each task of a command, and its display."""

    name: str
    """Text on the bar before the first report of a run."""
    work: Callable[[T, Tell], R]
    answer: Any
    """`work`, `answer`: see `Isolated`; the work reports how much of the task is done, in the unit of `size`."""
    label: Callable[[T], str]
    """Text on the bar for a task."""
    reads: Iterable[Path] = ()
    """Files that the runs read."""
    size: Callable[[T], float] = lambda task: 1.0
    """Weight of a task on the bar."""
    limit: float = PATIENCE
    in_all: bool = False
    """`limit`, `in_all`: time limit of a run, s, see `Isolated.do`."""
    finish: Callable[[T, R | None, Path], Any] = lambda task, result, store: result
    """See `Pool`."""

    def pool(self, jobs: int = 1) -> Pool[T, R]:
        """A pool of `jobs` processes of this machine."""
        return Pool(self.work, self.answer, jobs, self.reads, self.limit, self.finish, self.in_all)

    def results(
        self,
        tasks: Iterable[T],
        runner: Runner[T, R],
        told: Callable[[int, float], None] = lambda number, done: None,
        whole: float | None = None,
        before: float = 0.0,
    ) -> Generator[tuple[int, T, R | Lost]]:
        """Make runs with a progress bar; yield the number of each task, from 0, the task and its result when complete.

        `runner`: is closed with the iteration; `told`: called with the number of a task and how much of it is done;
        `whole`, `before`: total size of all tasks, needed where `tasks` is not a sequence, and of those already done.
        """
        if whole is None:
            tasks = list(tasks)
            whole = sum(map(self.size, tasks))
        with closing(runner), Progress(self, whole, before) as progress:
            yield from progress.results(tasks, runner, told)
        if runner.left:
            print(f"note: {runner.left} processes that an FMU had started were ended with it.", file=sys.stderr)


class Progress(Closable, Generic[T, R]):
    """The progress bar of an experiment, for one or several sequences of runs.

    `whole`: total size of all tasks; None: unknown, as of a search, and the bar counts; `before`: size of those already
    done.
    """

    def __init__(self, experiment: Experiment[T, R], whole: float | None = None, before: float = 0.0) -> None:
        self._experiment = experiment
        bar_format = _COUNTING_BAR_FORMAT if whole is None else _BAR_FORMAT
        self._bar = bar_of(total=whole, initial=before, bar_format=bar_format, desc=experiment.name)

    def close(self) -> None:
        """End the bar."""
        self._bar.close()

    def results(
        self, tasks: Iterable[T], runner: Runner[T, R], told: Callable[[int, float], None] = lambda number, done: None
    ) -> Generator[tuple[int, T, R | Lost]]:
        """Make runs as `Experiment.results`, without closing the runner."""
        pending: dict[int, tuple[T, float]] = {}

        def numbered_tasks() -> Generator[T]:
            for number, task in enumerate(tasks):
                pending[number] = task, 0.0
                yield task

        def show(number: int, done: float) -> float:
            task, shown = pending[number]
            total = min(max(done, shown), self._experiment.size(task))
            pending[number] = task, total
            self._bar.set_description_str(self._experiment.label(task), refresh=False)
            increment = total - shown
            self._bar.update(increment if self._bar.total is None else min(increment, self._bar.total - self._bar.n))
            return total

        for number, result in runner.results(numbered_tasks(), lambda number, done: told(number, show(number, done))):
            show(number, math.inf)
            yield number, pending.pop(number)[0], result
