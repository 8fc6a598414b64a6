"""Runs of an experiment, made by processes under one bar."""

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

_FORM = "{desc} {percentage:3.0f} % {bar} {elapsed} so far, {remaining} to go"
_COUNTED = "{desc} {n:.0f} done, {elapsed} so far"

T = TypeVar("T")
R = TypeVar("R")
T_contra = TypeVar("T_contra", contravariant=True)
R_co = TypeVar("R_co", covariant=True)


class Runner(Protocol[T_contra, R_co]):
    """What makes runs: processes of this machine (`Pool`), or workers of Dask (`hosts.experiment.cluster`)."""

    @property
    def left(self) -> int:
        """Processes that those of the runs had started and that were ended with them."""

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
    """On the bar, before the first word of a run."""
    work: Callable[[T, Tell], R]
    answer: Any
    """`work`, `answer`: see `Isolated`; the work reports how much of the task is done, in the unit of `size`."""
    label: Callable[[T], str]
    """Of a task, on the bar."""
    reads: Iterable[Path] = ()
    """Files that the runs read."""
    size: Callable[[T], float] = lambda task: 1.0
    """By which a task counts among the others."""
    limit: float = PATIENCE
    in_all: bool = False
    """`limit`, `in_all`: s after which a run is ended, see `Isolated.do`."""
    finish: Callable[[T, R | None, Path], Any] = lambda task, result, store: result
    """See `Pool`."""

    def pool(self, jobs: int = 1) -> Pool[T, R]:
        """So many processes of this machine that make the runs."""
        return Pool(self.work, self.answer, jobs, self.reads, self.limit, self.finish, self.in_all)

    def results(
        self,
        tasks: Iterable[T],
        runner: Runner[T, R],
        told: Callable[[int, float], None] = lambda number, done: None,
        whole: float | None = None,
        before: float = 0.0,
    ) -> Generator[tuple[int, T, R | Lost]]:
        """Make runs under a bar; give each result with its task and the number of that, from 0, as soon as it is there.

        `runner`: is closed with the iteration; `told`: called with the number of a task and how much of it is done;
        `whole`, `before`: sizes of all tasks, where `tasks` is not a sequence, and of those that are done already.
        """
        if whole is None:
            tasks = list(tasks)
            whole = sum(map(self.size, tasks))
        with closing(runner), Progress(self, whole, before) as progress:
            yield from progress.results(tasks, runner, told)
        if runner.left:
            print(f"note: {runner.left} processes that an FMU had started were ended with it.", file=sys.stderr)


class Progress(Closable, Generic[T, R]):
    """The bar of an experiment, over one list of runs or over several of which each depends on results of the last.

    `whole`: size of all tasks; None: nobody knows it, as of a search, and the bar counts; `before`: of those that are
    done already.
    """

    def __init__(self, experiment: Experiment[T, R], whole: float | None = None, before: float = 0.0) -> None:
        self._experiment = experiment
        form = _COUNTED if whole is None else _FORM
        self._bar = bar_of(total=whole, initial=before, bar_format=form, desc=experiment.name)

    def close(self) -> None:
        """End the bar."""
        self._bar.close()

    def results(
        self,
        tasks: Iterable[T],
        runner: Runner[T, R],
        told: Callable[[int, float], None] = lambda number, done: None,
    ) -> Generator[tuple[int, T, R | Lost]]:
        """See `Experiment.results`; the runner stays."""
        flying: dict[int, tuple[T, float]] = {}

        def sent() -> Generator[T]:
            for number, task in enumerate(tasks):
                flying[number] = task, 0.0
                yield task

        def shown(number: int, part: float) -> float:
            task, before = flying[number]
            now = min(max(part, before), self._experiment.size(task))
            flying[number] = task, now
            self._bar.set_description_str(self._experiment.label(task), refresh=False)
            increment = now - before
            self._bar.update(increment if self._bar.total is None else min(increment, self._bar.total - self._bar.n))
            return now

        for number, result in runner.results(sent(), lambda number, part: told(number, shown(number, part))):
            shown(number, math.inf)
            yield number, flying.pop(number)[0], result
