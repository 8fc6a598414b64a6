"""The catalogue command with several cars, and its refusals before the first run."""

import csv
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from hosts.catalogue.command import main
from hosts.catalogue.registry import TESTS
from hosts.common.options import FmuOptions
from hosts.view.view_sources import ViewRunOptions, recordings_of

FAST = ["--tests", "drop", "--test-setting", "drop.height=0.1", "--test-setting", "drop.duration=4"]
SSV = """<?xml version="1.0" encoding="UTF-8"?>
<ssv:ParameterSet xmlns:ssv="http://ssp-standard.org/SSP1/SystemStructureParameterValues" version="1.0" name="s">
<ssv:Parameters><ssv:Parameter name="front.tyre.stiffness"><ssv:Real value="40000"/></ssv:Parameter></ssv:Parameters>
</ssv:ParameterSet>
"""


def rows(folder: Path) -> list[dict[str, str]]:
    with (folder / "measures.csv").open(encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


@pytest.mark.slow
def test_cars_stand_side_by_side_and_processes_change_nothing(prototype_fmu, tmp_path, capsys):
    soft = tmp_path / "soft.ssv"
    soft.write_text(SSV, encoding="utf-8")
    for jobs in (1, 2):  # of processes of one thread, which give a fit its last digit
        out = tmp_path / f"out_{jobs}"
        sets = ["--variant", "as-is", "--variant", str(soft)]
        assert main([str(prototype_fmu), *FAST, *sets, "--jobs", str(jobs), "--out", str(out)]) == 0
    printed = capsys.readouterr().out
    first, second = tmp_path / "out_1", tmp_path / "out_2"
    assert (first / "measures.csv").read_bytes() == (second / "measures.csv").read_bytes()
    assert (first / "measures.json").read_bytes() == (second / "measures.json").read_bytes()
    tables = sorted(p.relative_to(first) for p in first.rglob("runs/**/*.csv"))
    assert len(tables) == 2
    for table in tables:
        assert (first / table).read_bytes() == (second / table).read_bytes()
        record = json.loads((first / table).with_suffix(".json").read_text(encoding="utf-8"))
        assert Path(record["fmu"]) == prototype_fmu
        (seen,), _, _ = recordings_of([first / table], None, ViewRunOptions(None, None, None, FmuOptions([], [])))
        assert seen.scene is not None
        assert seen.scene["shapes"]
    peak = {r["car"]: float(r["value"]) for r in rows(first) if (r["test"], r["measure"]) == ("drop", "load.peak_FL")}
    assert list(peak) == [prototype_fmu.stem, f"{prototype_fmu.stem}, soft"]
    assert peak[f"{prototype_fmu.stem}, soft"] < 0.95 * peak[prototype_fmu.stem]
    record = json.loads((first / "measures.json").read_text(encoding="utf-8"))
    assert record["cars"][1]["set"] == {"front.tyre.stiffness": 40000.0}
    assert [test["name"] for test in record["tests"]] == ["drop"]
    assert f"{prototype_fmu.stem}, soft" in printed
    assert "load.peak_FL" in printed


def test_a_test_that_cannot_be_done_is_a_row_with_its_reason(scene_fmu, tmp_path, capsys):
    fmu = scene_fmu(f"{Path(__file__).parents[1] / 'scenes.py'}:sledge")
    assert main([str(fmu), "--tests", "steady_circle", "--out", str(tmp_path / "out")]) == 1
    (row,) = rows(tmp_path / "out")
    assert row["measure"] == ""
    assert row["note"].startswith(f"The FMU {fmu.name} has no ")
    assert "vehicle.wheelbase" in row["note"]
    assert "1 of 1 tests could not be done" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--tests", "steady_circel"], "did you mean 'steady_circle'?"),
        (["--test-setting", "steady_circle.radius=3"], "it must be from 30 to 1000 m"),
        (["--test-setting", "steady_circle.radios=50"], "has no setting 'radios'"),
        (["--test-setting", "circle.radius=50"], "it must be TEST.NAME=VALUE"),
        (["--set", "road.frction=1"], "did you mean 'road.friction'"),
        (["--set", "initial.speed=3"], "the tests themselves say where a car starts"),
        (["--variant", "none.ssv"], "none.ssv"),
        (["--aliases", "carsim", "--aliases", "osi"], "1 FMUs and 2 alias files"),
        (["--step", "0.5"], "at most 0.1 s"),
    ],
)
def test_each_error_is_one_sentence_before_the_first_run(prototype_fmu, tmp_path, capsys, arguments, message):
    tests = [] if "--tests" in arguments else ["--tests", "steady_circle"]
    assert main([str(prototype_fmu), *tests, *arguments, "--out", str(tmp_path / "out")]) == 2
    error = capsys.readouterr().err
    assert error.startswith("error: ")
    assert message in error
    assert not (tmp_path / "out").exists()


def test_no_fmu_and_no_file_are_reported(tmp_path, capsys):
    assert main([]) == 2
    assert "There is no FMU to test" in capsys.readouterr().err
    assert main([str(tmp_path / "none.fmu")]) == 2
    assert "There is no file" in capsys.readouterr().err


def test_the_list_has_all_tests_with_their_settings(capsys):
    assert main(["--list"]) == 0
    printed = capsys.readouterr().out
    for name in TESTS:
        assert f"\n{name}: " in f"\n{printed}"
    assert "--test-setting steady_circle.radius=100 m (from 30 to 1000)" in printed
    assert "from public summaries" in printed


@pytest.mark.skipif(sys.platform == "win32", reason="sends SIGINT")
@pytest.mark.slow
def test_ctrl_c_keeps_the_written_files(prototype_fmu, tmp_path):
    """The drop is soon done, the circle goes on for minutes; then Ctrl-C."""
    out, pipe = tmp_path / "out", subprocess.PIPE
    slow = ["--tests", "drop,steady_circle", "--test-setting", "steady_circle.speed_rise=0.02", "--jobs", "2"]
    command = [sys.executable, "-m", "ali3", "catalogue", str(prototype_fmu), *slow, "--out", str(out)]
    process = subprocess.Popen(command, stdout=pipe, stderr=pipe, text=True, start_new_session=True)
    try:
        end = time.monotonic() + 400.0  # of a machine that others use
        while process.poll() is None and time.monotonic() < end:
            if (out / "measures.json").exists() and len(rows(out)) > 2:
                break
            time.sleep(0.2)
        assert process.poll() is None, process.communicate()[1]
        os.killpg(process.pid, signal.SIGINT)
        output, error = process.communicate(timeout=400.0)
    finally:
        process.kill()
    assert process.returncode == 130
    assert error.strip().endswith("stopped by Ctrl-C")
    assert "Traceback" not in error
    assert "1 of 2" not in output  # no verdict on what was not tried
    assert str(out / "report.html") in output
    assert "was stopped" in (out / "report.html").read_text()
    (unfinished,) = (row for row in rows(out) if row["test"] == "steady_circle")
    assert unfinished["note"] == "Not done yet: the command is still running, or was stopped."
    assert "load.peak_FL" in {row["measure"] for row in rows(out) if row["test"] == "drop"}
    assert list(out.rglob("runs/drop/*.csv"))
    assert "1 test is not done yet; the same command resumes here." in output
