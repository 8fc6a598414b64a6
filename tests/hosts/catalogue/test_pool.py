"""Tests as tasks of a pool: a fault is the outcome of its test, and nothing stays of one that is left."""

import os
import time
from typing import Any

import psutil
import pytest

from hosts.catalogue.car import TestedCar
from hosts.catalogue.standard_test import TestRecord
from hosts.catalogue.task import Task, perform_task, write_runs
from hosts.experiment.pool import Pool
from hosts.fmu.fmu_source import FmuSource
from tests.hosts.catalogue.bicycle_car import BicycleCar

FAST = {"method": 3.0, "steering_rate": 30.0}


class FaultyCar(BicycleCar):
    """It fails as only a program error does."""

    def drive(self, *_: Any, **__: Any) -> Any:
        """See `TestedCar.drive`."""
        return {}["nothing"]


def test_a_fault_is_the_outcome_of_its_test_and_runs_are_written(tmp_path):
    good, faulty = (Task("steady_circle", car, FAST, tmp_path) for car in (BicycleCar(label="b"), FaultyCar()))
    parts: list[float] = []
    outcome = perform_task(good, parts.append)
    assert isinstance(outcome, TestRecord)
    assert len(parts) > 1
    write_runs(good, outcome)
    assert sorted(p.name for p in (tmp_path / "runs" / "steady_circle").iterdir()) == [
        *("b_left.csv", "b_left.json", "b_right.csv", "b_right.json")
    ]
    assert "KeyError('nothing')" in str(perform_task(faulty, parts.append))


@pytest.mark.slow
def test_processes_and_their_unpacked_files_end_with_the_iteration(tmp_path, monkeypatch, prototype_fmu):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    others = psutil.Process().children()
    slow = Task("steady_circle", TestedCar("slow", FmuSource(prototype_fmu)), {"speed_rise": 0.02})
    tasks = [slow, Task("steady_circle", FaultyCar(), FAST)]  # type: ignore[arg-type]
    iteration = Pool(perform_task, TestRecord | str, 2).results(tasks)
    assert next(iteration)[0] == 1
    end = time.monotonic() + 400.0  # of a machine that others use
    while not any("modelDescription.xml" in files for _, _, files in os.walk(tmp_path)) and time.monotonic() < end:
        time.sleep(0.05)
    children = [child for child in psutil.Process().children() if child not in others]
    assert len(children) == 2
    iteration.close()
    assert not any(child.is_running() for child in children)
    assert not list(tmp_path.iterdir())
