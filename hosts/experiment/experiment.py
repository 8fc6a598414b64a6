"""Runs of an experiment: made in processes under one bar, each kept in a folder from the moment it is there."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Generator, Iterable
from contextlib import ExitStack, closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Generic, Protocol, TypeVar

from ali3.bars import bar as bar_of
from ali3.isolated import Lost, Tell
from ali3.locks import locked
from hosts.common.closing import Closing
from hosts.experiment.journal import Journal
from hosts.experiment.pool import Pool
from hosts.fmu.own_process import PATIENCE

_FORM = "{desc} {percentage:3.0f} % {bar} {elapsed} so far, {remaining} to go"

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
        """End what is in hand."""


@dataclass(frozen=True)
class Experiment(Generic[T, R]):
    """What is done with each task of a command."""

    name: str
    """On the bar, before the first word of a run."""
    work: Callable[[T, Tell], R]
    answer: Any
    """`work`, `answer`: see `Isolated`; the work tells how much of the task is done, in the unit of `size`."""
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
        `whole`, `before`: sizes of all tasks, where `tasks` is no sequence, and of those that are done already.
        """
        if whole is None:
            tasks = list(tasks)
            whole = sum(map(self.size, tasks))
        flying: dict[int, tuple[T, float]] = {}

        def sent() -> Generator[T]:
            for number, task in enumerate(tasks):
                flying[number] = task, 0.0
                yield task

        with closing(runner), bar_of(total=whole, initial=before, bar_format=_FORM, desc=self.name) as bar:

            def shown(number: int, part: float) -> float:
                task, done = flying[number]
                now = min(max(part, done), self.size(task))
                flying[number] = task, now
                bar.set_description_str(self.label(task), refresh=False)
                bar.update(min(now - done, bar.total - bar.n))  # a sum of parts rounds
                return now

            for number, result in runner.results(sent(), lambda number, part: told(number, shown(number, part))):
                shown(number, math.inf)
                yield number, flying.pop(number)[0], result
        if runner.left:
            print(f"note: {runner.left} processes that an FMU had started were ended with it.", file=sys.stderr)


class Kept(Closing, Generic[R]):
    """Results that stay in a folder, so that the same command goes on with the others; the folder is locked.

    `kind`: type of the results, see `Journal`; `does`: what the command does, in the sentence for another one that
    finds the folder in use; `again`: whether none of them is found.
    """

    def __init__(self, folder: Path, kind: Any, does: str, again: bool = False) -> None:
        busy = f"Another program {does} in {folder}; wait for it, or give another --out."
        with ExitStack() as held:
            held.enter_context(locked(folder, busy))
            self._journal: Journal[tuple[str, R]] = held.enter_context(Journal(folder / "done", tuple[str, kind]))
            there = self._journal.read()
            self._found = {} if again else there
            self._held = held.pop_all()

    def find(self, name: str, key: str) -> R | None:
        """The result of a name, if what it depends on has the same key (`run_key`) as then."""
        was, result = self._found.get(name, ("", None))
        return result if was == key else None

    def add(self, name: str, key: str, result: R) -> None:
        """Keep a result; it takes the place of that of the same name."""
        self._journal.add(name, (key, result))

    def close(self) -> None:
        """Close the file, and free the folder."""
        self._held.close()


def tell_kept(there: int, of: int, what: str) -> None:
    """Say how many results need not be made again; `what`: they are, such as ``tests``."""
    if there:
        print(f"{there} of {of} {what} are there; --again makes them again.", flush=True)
