"""Runs of an experiment in the process of the test, where another start of Python for them would tell nothing more."""

import pickle
from collections.abc import Callable, Generator, Iterable, Iterator
from contextlib import contextmanager
from typing import Any

import pytest


class PoolInProcess:
    """In place of `hosts.experiment.pool.Pool`; the work comes through a pickle, as in a process of its own."""

    left = 0

    def __init__(self, work: Callable[..., Any], *_: object) -> None:
        self._work: Any = pickle.loads(pickle.dumps(work))

    def run(self, task: Any) -> Any:
        """See `Pool.run`."""
        return self._work(task, lambda word: None)

    def results(self, tasks: Iterable[Any], told: object) -> Generator[tuple[int, Any]]:
        """See `Pool.results`."""
        for number, task in enumerate(tasks):
            yield number, self.run(task)

    def close(self) -> None:
        """Free the FMU of a study."""
        if hasattr(self._work, "close"):
            self._work.close()


@contextmanager
def runs_in_this_process() -> Iterator[None]:
    """All runs but those of a scheduler are made by `PoolInProcess`."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("hosts.experiment.experiment.Pool", PoolInProcess)
        yield
