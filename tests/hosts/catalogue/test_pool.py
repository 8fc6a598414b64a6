"""Tests in processes of their own: a crash is the outcome of its test, and the others continue."""

import os
import sys
import time
from pathlib import Path

import psutil
import pytest

from ali3.isolated_processes import Lost
from hosts.catalogue.car import TestedCar
from hosts.catalogue.record import TestRecord
from hosts.catalogue.task import Task, do, write_runs
from hosts.experiment.pool import Pool
from hosts.fmu.fmu_source import FmuSource
from tests.hosts.catalogue.bicycle_car import BicycleCar
from tests.hosts.catalogue.crashing_car import CrashingCar, FaultyCar

FAST = {"method": 3.0, "steering_rate": 30.0}


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="ends a process by a signal")
def test_a_crash_and_a_fault_are_rows_and_the_others_are_done(tmp_path: Path) -> None:
    cars = [CrashingCar(label="a"), BicycleCar(label="b"), FaultyCar(label="c"), BicycleCar(label="d", ratio=20.0)]
    tasks = [Task("steady_circle", car, FAST, tmp_path) for car in cars]  # type: ignore[arg-type]
    heard: list[tuple[int, float]] = []
    with Pool(do, TestRecord | str, 2) as pool:
        outcomes = dict(pool.results(tasks, lambda place, part: heard.append((place, part))))
    assert set(outcomes) == {0, 1, 2, 3}
    assert isinstance(outcomes[0], Lost)
    assert outcomes[0].how.startswith("was killed (SIGKILL)")
    assert "KeyError('nothing')" in str(outcomes[2])
    for place in (1, 3):
        outcome = outcomes[place]
        assert isinstance(outcome, TestRecord)
        write_runs(tasks[place], outcome)
        assert place in {k for k, _ in heard}
    assert sorted(p.name for p in (tmp_path / "runs" / "steady_circle").iterdir()) == [
        *("b_left.csv", "b_left.json", "b_right.csv", "b_right.json"),
        *("d_left.csv", "d_left.json", "d_right.csv", "d_right.json"),
    ]


@pytest.mark.slow
def test_processes_and_their_unpacked_files_end_with_the_iteration(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, prototype_fmu: Path
) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    others = psutil.Process().children()
    slow = Task("steady_circle", TestedCar("slow", FmuSource(prototype_fmu)), {"speed_rise": 0.02})
    tasks = [slow, Task("steady_circle", FaultyCar(), FAST)]  # type: ignore[arg-type]
    iteration = Pool(do, TestRecord | str, 2).results(tasks)
    assert next(iteration)[0] == 1
    end = time.monotonic() + 30.0
    while not any("modelDescription.xml" in files for _, _, files in os.walk(tmp_path)) and time.monotonic() < end:
        time.sleep(0.05)
    children = [child for child in psutil.Process().children() if child not in others]
    assert len(children) == 2
    iteration.close()
    assert not any(child.is_running() for child in children)
    assert not list(tmp_path.iterdir())
