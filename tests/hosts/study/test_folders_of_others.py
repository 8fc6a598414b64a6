"""Folders of results by others: rows are read, no program is run, no link is followed."""

import copy
import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from hosts.common.errors import HostError
from hosts.study.analysis.report import write_report
from hosts.study.command import main
from hosts.study.folder import begin_study, read_record, write_record
from hosts.study.outcome_table import OutcomeTable
from hosts.study.plan import make_plan
from hosts.study.repeated_run import repeater
from hosts.study.store import read_study
from hosts.study.study_file import read_study_file
from hosts.study.worker_data import Outcome


@pytest.fixture
def folder(study_file: Callable[..., Path], tuned: Path, tmp_path: Path) -> Path:
    """Results of a study, whose rows were written without a run."""
    file = study_file()
    study, content = read_study_file(file)
    plan = make_plan(study, file, tuned)
    record = json.loads(json.dumps(plan.record))
    begin_study(tmp_path / "out", record, content, tuned)
    table = OutcomeTable(tmp_path / "out", record)
    for k, run in enumerate(plan.runs_at(range(plan.runs))):
        table.take("", (run, Outcome(measures={"highest": 0.1 * k})))
    table.write()
    return tmp_path / "out"


def fmu_in(folder: Path) -> Path:
    (result,) = folder.glob("*.fmu")
    return result


@pytest.mark.parametrize("number", [float("nan"), float("inf")])
def test_a_record_has_finite_numbers(tmp_path: Path, number: float) -> None:
    record = {"manoeuvres": [{"speed": number}]}  # a key of its own, which no type checks
    with pytest.raises(ValueError, match="not JSON compliant"):
        write_record(tmp_path, record)
    assert read_record(tmp_path) is None
    (tmp_path / "study.json").write_text(json.dumps(record), encoding="utf-8")
    with pytest.raises(HostError, match="speed is (nan|inf); it must be a finite number"):
        read_record(tmp_path)


def test_a_report_opens_no_fmu(folder: Path) -> None:
    fmu_in(folder).write_bytes(b"no FMU")
    files = write_report(folder)
    assert f"study {folder} --run 15</code>" in files[0].read_text(encoding="utf-8")
    fmu_in(folder).unlink()
    assert write_report(folder) == files


def test_another_fmu_is_reported_and_not_opened(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    repeater(folder)(3)
    with fmu_in(folder).open("ab") as file:
        file.write(b"\0")
    assert main([str(folder), "--run", "3"]) == 2
    errors = capsys.readouterr().err
    assert errors.count("\n") == 1
    assert f"{fmu_in(folder)} is another FMU than the one that made the rows: its SHA-256 is " in errors
    fmu_in(folder).unlink()
    with pytest.raises(HostError, match="It made the runs of this study; put it back"):
        repeater(folder)


@pytest.mark.parametrize("name", ["report.html", "analysis", "analysis/effects.csv", "repeat", "repeat/run-3.toml"])
def test_nothing_is_written_through_a_link(name: str, folder: Path, tmp_path: Path) -> None:
    victim = tmp_path / "victim"
    (folder / name).parent.mkdir(exist_ok=True)
    if "." in name:
        victim.write_text("mine")
    else:
        victim.mkdir()
    (folder / name).symlink_to(victim)
    for write in (write_report, lambda folder: repeater(folder)(3)):
        with pytest.raises(HostError, match=f"{name} is a link; nothing is written through it"):
            write(folder)
    assert victim.read_text() == "mine" if victim.is_file() else list(victim.iterdir()) == []


def alterations(record: dict[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Records in which one place was taken away, or is of another kind; each with the place."""
    strange: tuple[Any, ...] = (None, [], {}, -1, 2**62, 1.5, "", "../x", [[1]], {"a": {"b": 1}}, True)

    def places(value: Any, path: tuple[Any, ...]) -> Iterator[tuple[Any, ...]]:
        if path:
            yield path
        for key in value if isinstance(value, dict) else range(len(value)) if isinstance(value, list) else ():
            yield from places(value[key], (*path, key))

    for path in places(record, ()):
        for value in (KeyError, *strange):
            altered = copy.deepcopy(record)
            inner = altered
            for key in path[:-1]:
                inner = inner[key]
            if value is KeyError:
                del inner[path[-1]]
            else:
                inner[path[-1]] = value
            yield f"{path} {value}", altered


@pytest.mark.slow
def test_each_altered_record_is_read_or_one_sentence(folder: Path) -> None:
    """None ends in another error; those that keep their form are read as rows of what they say."""
    record = read_record(folder)
    assert record is not None
    refused = taken = 0
    for where, altered in alterations(record):
        (folder / "study.json").write_text(json.dumps(altered))
        try:
            read_study(folder)
        except HostError as error:
            refused += 1
            message = str(error)
        else:
            taken += 1
            continue
        assert (message.count("\n"), message.count(str(folder))) == (0, 1), where
    assert refused > 3 * taken > 0
    (folder / "study.json").write_text(json.dumps(record | {"fmu": "../../bin/x.fmu"}))
    with pytest.raises(HostError, match="fmu is '../../bin/x.fmu'; it must be the name of a file in this folder"):
        read_record(folder)
