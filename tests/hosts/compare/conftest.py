"""The folder of these tests on the import path; work of other processes inside that of the tests."""

import pickle
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from ali3.temporary_folder import temporary_folder

HERE = Path(__file__).parent
if str(HERE) not in sys.path:
    sys.path.append(str(HERE))  # for what the tests share


class _NoProcess:
    """In place of `Isolated`: a start of Python for an FMU takes ten times as long as its drive."""

    left = 0

    def __init__(self, work: Callable[[Any, Any], Any], *_: object, **options: object) -> None:
        self._work = pickle.loads(pickle.dumps(work))

    def do(
        self,
        task: object,
        tell: Callable[[Any], None] = lambda word: None,
        limit: float | None = None,
        finish: Callable[[Any, Path], Any] = lambda result, store: result,
        in_all: bool = False,
    ) -> object:
        with temporary_folder() as folder, pytest.MonkeyPatch.context() as patch:
            patch.setattr("ali3.processes._store", folder / "rows")
            return finish(self._work(task, tell), folder / "rows")

    def close(self) -> None:
        pass


@pytest.fixture
def in_this_process(monkeypatch: pytest.MonkeyPatch) -> pytest.MonkeyPatch:
    """FMUs are driven in the process of the tests until `undo`; `test_coverage.py` drives them as a user does."""
    monkeypatch.setattr("hosts.experiment.pool.Isolated", _NoProcess)
    monkeypatch.setattr("hosts.fmu.own_process.Isolated", _NoProcess)
    return monkeypatch
