"""Messages before a study: its plan, that of the example, and a measure that the trial runs could not compute."""

from pathlib import Path

import numpy as np
import pytest

from hosts.common.road import road_value
from hosts.driving.manoeuvre import Manoeuvre
from hosts.fmu.fmu_source import FmuSource
from hosts.study.campaign import run_study
from hosts.study.command import main
from hosts.study.jobs import Job
from hosts.study.study_runs import SingleProcess
from hosts.study.worker_data import Run, Work

pytestmark = pytest.mark.usefixtures("in_process")


def test_a_function_that_raises_is_reported_before_the_study(study_file, tmp_path, capsys):
    (tmp_path / "own.py").write_text("def value(result):\n    raise ArithmeticError('no such number')\n")
    run_study(study_file(more='own = "own.py:value"\n'), tmp_path / "out", None, None, dry=True)
    errors = capsys.readouterr().err
    assert "note: Run 0, fall, is incomplete: " in errors
    assert "no such number" in errors


@pytest.mark.parametrize(("workers", "message"), [(1, "in all on one worker"), (2, "in all with 2 workers")])
def test_the_plan_names_its_workers(study_file, tmp_path, capsys, workers, message):
    run_study(study_file(), tmp_path / "out", None, workers, dry=True)
    assert message in capsys.readouterr().out


@pytest.mark.slow
@pytest.mark.parametrize(("x", "reported"), [(550.0, 0), (0.0, 1)])
def test_a_start_is_reported_where_a_run_has_it(tmp_path, capfd, x, reported):
    (tmp_path / "far.csv").write_text("x,-5,0,5\n500,0,0,0\n550,0,0,0\n600,0,0,0\n")
    start = {"road.file": road_value(str(tmp_path / "far.csv"), tmp_path)}
    job = Job("far", Manoeuvre("far", np.zeros(1), {}, 1.0, start))
    work = Work(FmuSource(Path("none.fmu")), "", "", "", (job,), ("initial.x",), (), (), ())
    with SingleProcess(work, tmp_path / "none.fmu") as processes:
        assert "none.fmu" in processes.run(Run(0, {"initial.x": x})).reason
    assert capfd.readouterr().err.count("warning: ") == reported


EXAMPLE = Path(__file__).parents[3] / "examples" / "handling_study.toml"


@pytest.mark.slow
def test_the_example_is_a_plan(prototype_fmu, tmp_path, in_process, monkeypatch, capsys):
    monkeypatch.setattr("hosts.study.campaign.fmu_of_car", lambda car, *_: {"prototype": prototype_fmu}[car])
    assert main([str(EXAMPLE), "--dry-run", "--out", str(tmp_path / "out")]) == 0
    assert "192 points x 1 = 192 runs" in capsys.readouterr().out
    assert "192 runs" in EXAMPLE.read_text(encoding="utf-8")
    assert not (tmp_path / "out").exists()
