"""A failed run is a row with its reason, even if its process ends."""

import math
import re
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from hosts.driving.manoeuvre import Manoeuvre
from hosts.fmu.fmu_source import FmuSource
from hosts.study.campaign import run_study
from hosts.study.jobs import Job
from hosts.study.store import read_study
from hosts.study.study_runs import Bench
from hosts.study.worker_data import Work
from tests.hosts.in_this_process import in_this_process

TESTS = Path(__file__).parents[2]
BAD = """
import os
import signal
import time

def value(result, parameters):
    k = parameters["spring.stiffness"]
    if "REPAIRED" in os.environ:
        return k
    if k == 52.0:
        raise ArithmeticError("not this one")
    if k == 53.0:
        os.kill(os.getpid(), signal.SIGKILL)
    if k == 54.0:
        time.sleep(1000.0)
    if k == 55.0:
        os._exit(3)
    return float("nan") if k == 56.0 else k

value.units = "N/m"
"""
TABLE = "spring.stiffness\n" + "".join(f"{k}\n" for k in range(50, 60))


def table_study(study_file: Callable[..., Path], folder: Path) -> Path:
    (folder / "table.csv").write_text(TABLE)
    (folder / "bad.py").write_text(BAD)
    return study_file(
        ('method = "sobol"\nruns = 16\nseed = 7', 'method = "table"\nfile = "table.csv"'),
        ('"spring.stiffness" = { range = [50.0, 80.0] }\n', ""),
        ('"spring.free_length" = { range = [0.5, 0.8] }\n', ""),
        ('"max(bob.y)"', '"max(bob.y)"\nown = "bad.py:value"'),
        ("step = 0.01", "step = 0.01\ntime_limit = 2.0"),
    )


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="signals")
def test_runs_that_raise_crash_or_hang_are_rows_and_are_made_again(study_file, tmp_path, monkeypatch, capsys):
    file = table_study(study_file, tmp_path)
    ended = run_study(file, tmp_path / "out", None, 2)
    assert ended is not None
    assert (ended.good, ended.failed) == (True, 3)
    table = read_study(ended.folder)
    good = [0, 1, 7, 8, 9]
    assert (
        table.loc[good, "own"].tolist()
        == table.loc[good, "spring.stiffness"].tolist()
        == [50.0, 51.0, 57.0, 58.0, 59.0]
    )
    assert (table.loc[good, "status"] == "done").all()
    assert table.loc[[2, 6], "status"].tolist() == ["incomplete", "incomplete"]
    assert "not this one" in table.loc[2, "reason"]
    assert math.isfinite(table.loc[2, "highest"])
    failed = table.loc[[3, 4, 5]]
    assert (failed["status"] == "failed").all()
    assert failed["highest"].isna().all()
    assert [re.sub(r" (after|in) fmi2\w+", "", reason) for reason in failed["reason"]] == [
        "The process of the run was killed (SIGKILL), by a user or by the system because memory ran out.",
        "The run took more than 2 s (time_limit).",
        "The process of the run ended with exit code 3.",
    ]
    monkeypatch.setenv("REPAIRED", "1")
    with in_this_process():
        ended = run_study(file, tmp_path / "out", None, 1, again=True)
    assert ended is not None
    assert (ended.good, ended.failed) == (True, 0)
    assert "3 failed runs are repeated" in capsys.readouterr().out
    repaired = read_study(ended.folder)
    assert repaired["status"].tolist() == table["status"].replace("failed", "done").tolist()
    assert repaired.loc[[3, 4, 5], "own"].tolist() == [53.0, 54.0, 55.0]


def test_a_refused_step_is_a_reason(scene_fmu):
    fmu = scene_fmu(f"{TESTS / 'fmu' / 'scenes.py'}:reach")
    manoeuvre = Manoeuvre("pull", np.array([0.0, 1.0]), {"pull": np.array([0.0, 10.0])}, 1.0)
    job = Job("pull", manoeuvre, step=0.01, every=10, samples=11)
    work = Work(FmuSource(fmu), "", "", "", (job,), (), (), (), ("bob.x",), reuse=True)
    bench = Bench(work, fmu)
    outcome = bench.run(job, {}, 0)
    assert outcome.status == "failed"
    assert outcome.reason.startswith(f"The FMU refused the step at {outcome.simulated:g} s: ")
    assert 0.0 < outcome.simulated < 1.0
    assert outcome.signals is not None
    present = int(outcome.simulated / 0.1 + 1e-6) + 1
    assert np.isfinite(outcome.signals[:present]).all()
    assert np.isnan(outcome.signals[present:]).all()
    # the next run is not harmed by it
    still = replace(job, manoeuvre=replace(manoeuvre, inputs={"pull": np.zeros(2)}))
    assert bench.run(still, {}, 0).status == "done"
    bench.close()
    assert bench.run(job, {"none": 1.0}, 0).reason.startswith("The FMU has no parameter or input 'none'")
    bench.close()


@pytest.mark.usefixtures("in_process")
def test_a_study_without_a_measure_is_not_good(
    study_file: Callable[..., Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "none.py").write_text("def value(result):\n    return float('nan')\n")
    file = study_file(('"max(bob.y)"', '"max(bob.y)"\nown = "none.py:value"'))
    ended = run_study(file, tmp_path / "out", None, 1)
    assert ended is not None
    assert (ended.good, ended.failed) == (False, 0)
    assert "No run has yielded all its measures" in capsys.readouterr().err
