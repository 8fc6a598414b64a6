"""Runs of an experiment: made in processes under one bar, each kept in a folder from the moment it is there."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Generic, TypeVar

from ali3.bars import bar as bar_of
from ali3.isolated import Lost, Tell
from ali3.locks import locked
from hosts.common.closing import Closing
from hosts.experiment.journal import Journal
from hosts.experiment.pool import Pool

_FORM = "{desc} {percentage:3.0f} % {bar} {elapsed} so far, {remaining} to go"

T = TypeVar("T")
R = TypeVar("R")


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
    reads: Callable[[T], Iterable[Path]]
    """Files that the run of a task reads."""
    size: Callable[[T], float] = lambda task: 1.0
    """By which a task counts among the others."""

    def results(
        self, tasks: Sequence[T], jobs: int, told: Callable[[int, float], None] = lambda number, done: None
    ) -> Generator[tuple[int, R | Lost]]:
        """Make runs under a bar; give each result with the number of its task, from 0, as soon as it is there.

        `told`: called with the number of a task and how much of it is done.
        """
        sizes = [self.size(task) for task in tasks]
        done, reads = [0.0] * len(tasks), [file for task in tasks for file in self.reads(task)]
        with (
            bar_of(total=sum(sizes), bar_format=_FORM, desc=self.name) as bar,
            Pool(self.work, self.answer, jobs, reads) as pool,
        ):

            def shown(number: int, part: float) -> None:
                done[number] = min(max(part, done[number]), sizes[number])
                bar.set_description_str(self.label(tasks[number]), refresh=False)
                bar.update(sum(done) - bar.n)

            def progress(number: int, part: float) -> None:
                shown(number, part)
                told(number, done[number])

            for number, result in pool.results(tasks, progress):
                shown(number, sizes[number])
                yield number, result


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
