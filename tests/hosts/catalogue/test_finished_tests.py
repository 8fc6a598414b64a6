"""The same command keeps finished tests; a changed test, program or FMU is run again."""

from dataclasses import replace
from pathlib import Path

import pytest

from hosts.catalogue import campaign, command
from hosts.catalogue.car import TestedCar
from hosts.catalogue.execution import settings_of_test
from hosts.catalogue.output import measures_csv
from hosts.catalogue.registry import standard_test
from hosts.catalogue.standard_test import TestRecord
from hosts.catalogue.task import Task, find_record, perform_task, store_record, write_runs
from hosts.experiment.store import ResultStore
from hosts.fmu.fmu_source import FmuSource

SETTINGS = {"height": 0.05, "duration": 4.0}


def kept(task: Task, out: Path) -> TestRecord | None:
    with ResultStore[TestRecord](out, TestRecord, "does tests") as there:
        return find_record(there, task)


@pytest.mark.slow
def test_kept_records_are_those_of_the_runs(prototype_fmu, tmp_path, monkeypatch, capsys):
    drop = standard_test("drop")
    task = Task(
        "drop", TestedCar(prototype_fmu.stem, FmuSource(prototype_fmu)), settings_of_test(drop, SETTINGS), tmp_path
    )
    assert kept(task, tmp_path) is None
    record = perform_task(task, lambda part: None)
    assert isinstance(record, TestRecord)
    write_runs(task, record)
    with ResultStore[TestRecord](tmp_path, TestRecord, "does tests") as there:
        store_record(there, task, record)
    again = kept(task, tmp_path)
    assert again is not None
    assert measures_csv([drop], {"drop": {"p": again}}) == measures_csv([drop], {"drop": {"p": record}})
    assert [list(x.runs) for x in (again, record)] == [["drop"], ["drop"]]
    assert list(again.notes) == list(record.notes)
    for ours, theirs in zip(again.plots, record.plots, strict=True):
        assert (ours.title, ours.x, ours.y, ours.equal) == (theirs.title, theirs.x, theirs.y, theirs.equal)
        for a, b in zip(ours.lines, theirs.lines, strict=True):
            assert (a.label, a.x.tobytes(), a.y.tobytes()) == (b.label, b.x.tobytes(), b.y.tobytes())

    def undone(tasks: list[Task], *_: object) -> object:
        yield from (pytest.fail("it was done again") for _ in tasks)

    monkeypatch.setattr(campaign, "_finished_tasks", undone)
    options = [part for name, x in SETTINGS.items() for part in ("--test-setting", f"drop.{name}={x}")]
    assert command.main([str(prototype_fmu), "--tests", "drop", "--out", str(tmp_path), *options]) == 0
    output = capsys.readouterr().out
    assert "1 of 1 tests are there; --again repeats them." in output
    assert "load.peak_FL" in output

    assert kept(replace(task, settings={**task.settings, "height": 0.06}), tmp_path) is None
    assert kept(replace(task, car=replace(task.car, start={"front.tyre.grip": 0.9})), tmp_path) is None
    assert kept(task, tmp_path) is not None
    file = tmp_path / "done"
    content = file.read_bytes()
    file.write_bytes(content[:-9])
    assert kept(task, tmp_path) is None
    file.write_bytes(content)
    next((tmp_path / "runs" / "drop").glob("*.csv")).unlink()
    assert kept(task, tmp_path) is None
