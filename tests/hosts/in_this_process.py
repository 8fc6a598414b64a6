"""FMUs driven in the process of the test: a start of Python for one takes ten times as long as its drive."""

import pickle
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Lock
from typing import Any

import pytest

from ali3.isolated_processes import Lost
from ali3.temporary_folder import temporary_folder

_ONE_STORE = Lock()
"""The store is one of the process: tasks of a pool follow each other."""


class NoProcess:
    """In place of `ali3.isolated_processes.Isolated`; the work comes through a pickle, as in a process of its own."""

    left = 0

    def __init__(self, work: Callable[[Any, Any], Any], *_: object, **options: object) -> None:
        self._work: Any = pickle.loads(pickle.dumps(work))
        self._closed = False

    def do(
        self,
        task: object,
        tell: Callable[[Any], None] = lambda word: None,
        limit: float | None = None,
        finish: Callable[[Any, Path], Any] = lambda result, store: result,
        in_all: bool = False,
    ) -> object:
        """See `Isolated.do`."""
        with _ONE_STORE, temporary_folder() as folder, pytest.MonkeyPatch.context() as patch:
            if self._closed:
                return Lost("was ended")
            store = folder / "rows"
            patch.setattr("ali3.processes._store", store)
            return finish(self._work(task, tell), store)

    def close(self) -> None:
        """Free the FMU of a study, behind the run that a process would be ended in."""
        with _ONE_STORE:
            self._closed = True
            if hasattr(self._work, "close"):
                self._work.close()


@contextmanager
def in_this_process() -> Iterator[pytest.MonkeyPatch]:
    """All drives but those of a scheduler and of the simulator are made by `NoProcess`, until `undo` or the end."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("hosts.experiment.pool.Isolated", NoProcess)
        patch.setattr("hosts.fmu.own_process.Isolated", NoProcess)
        yield patch
