"""An experiment shows its progress, and its folder keeps finished runs for the same command."""

import os
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest

from ali3.errors import FileError
from ali3.isolated_processes import Lost
from ali3.processes import store
from hosts.experiment.experiment import Experiment
from hosts.experiment.store import ResultStore, report_resumed


def half(task: float, tell: Callable[[Any], None]) -> float:
    """Tells half of its task, then more than all of it."""
    tell(0.5 * task)
    if task == 3.0:
        os._exit(7)
    tell(2.0 * task)
    return -task


def test_progress_is_reported_and_a_lost_task_is_a_result():
    experiment: Experiment[float, float] = Experiment("halves", half, float, str, size=lambda task: task)
    progress: list[tuple[int, float]] = []
    with closing(experiment.results([2.0, 3.0], experiment.pool(), lambda *word: progress.append(word))) as results:
        actual = {number: (task, result) for number, task, result in results}
    assert actual[0] == (2.0, -2.0)
    assert actual[1][0] == 3.0
    assert isinstance(actual[1][1], Lost)
    assert [done for number, done in progress if number == 0] == [1.0, 2.0]  # never more than there is
    assert [done for number, done in progress if number == 1] == [1.5]


def tenths(task: float, tell: Callable[[Any], None]) -> float:
    for k in range(10):
        tell(0.1 * k)
    return task


def test_parts_that_are_rounded_are_no_more_than_the_whole(monkeypatch):
    """The bar warns of more, which is an error here."""
    monkeypatch.setattr("ali3.bars.DELAY", 0.0)
    experiment: Experiment[float, float] = Experiment("tenths", tenths, float, str, size=lambda task: 60.3)
    with closing(experiment.results(9 * [0.0], experiment.pool())) as results:
        assert len(list(results)) == 9


def stored(task: float, tell: Callable[[Any], None]) -> float:
    """Leaves its task in the store; the third is lost."""
    place = store()
    assert place is not None
    place.write_bytes(str(task).encode())
    if task == 3.0:
        os._exit(7)
    return 0.0


def test_a_result_is_finished_out_of_the_store_and_of_a_lost_one_that_is_kept():
    """Each task has its own, though they share a process."""

    def finish(task: float, result: float | None, place: Path) -> str:
        return f"{task} {result} {place.read_text()}"

    experiment: Experiment[float, Any] = Experiment("stores", stored, float, str, finish=finish)
    with closing(experiment.results(iter([2.0, 3.0, 4.0]), experiment.pool(), whole=3.0)) as results:
        actual = [result.kept if isinstance(result, Lost) else result for _, _, result in results]
    assert actual == ["2.0 0.0 2.0", "3.0 None 3.0", "4.0 0.0 4.0"]


def test_a_result_is_found_by_its_name_while_its_key_is_the_same(tmp_path, capsys):
    with ResultStore[float](tmp_path, float, "counts") as store:
        store.add("a", "key", 1.0)
        store.add("b", "key", 2.0)
        store.add("b", "other", 3.0)
        with pytest.raises(FileError, match=r"Another program counts in .*; wait for it, or give another --out\."):
            ResultStore[float](tmp_path, float, "counts")
    with ResultStore[float](tmp_path, float, "counts") as store:
        assert [store.find("a", "key"), store.find("b", "key"), store.find("b", "other")] == [1.0, None, 3.0]
    with ResultStore[float](tmp_path, float, "counts", again=True) as store:
        assert store.find("a", "key") is None
        store.add("a", "key", 4.0)
    with ResultStore[float](tmp_path, float, "counts") as store:
        assert [store.find("a", "key"), store.find("b", "other")] == [4.0, 3.0]
    report_resumed(0, 2, "counts")
    report_resumed(1, 2, "counts")
    assert capsys.readouterr().out == "1 of 2 counts are there; --again repeats them.\n"
