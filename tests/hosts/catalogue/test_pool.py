"""Tests run in processes of their own: what one does to itself is its outcome, and the others go on."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from hosts.catalogue.pool import done_by
from hosts.catalogue.record import TestRecord
from hosts.catalogue.task import Task
from tests.hosts.catalogue.bicycle_car import BicycleCar
from tests.hosts.catalogue.crashing_car import CrashingCar, FaultyCar

FAST = {"method": 3.0, "steering_rate": 30.0}


@pytest.mark.skipif(sys.platform == "win32", reason="ends a process by a signal")
def test_a_crash_and_a_fault_are_rows_and_the_others_are_done(tmp_path: Path) -> None:
    cars = [CrashingCar(label="a"), BicycleCar(label="b"), FaultyCar(label="c"), BicycleCar(label="d", ratio=20.0)]
    tasks = [Task("steady_circle", car, FAST, tmp_path) for car in cars]  # type: ignore[arg-type]
    heard: list[tuple[int, float]] = []
    outcomes = dict(done_by(tasks, 2, lambda place, part: heard.append((place, part))))
    assert set(outcomes) == {0, 1, 2, 3}
    assert outcomes[0] == "The process of the test ended by the signal SIGKILL: the FMU has crashed."
    assert "KeyError('nothing')" in str(outcomes[2])
    for place in (1, 3):
        assert isinstance(outcomes[place], TestRecord)
        assert place in {k for k, _ in heard}
    assert sorted(p.name for p in (tmp_path / "runs" / "steady_circle").iterdir()) == [
        *("b_left.csv", "b_right.csv"),
        *("d_left.csv", "d_right.csv"),
    ]


def test_processes_end_with_the_iteration() -> None:
    tasks = [Task("steady_circle", BicycleCar(), {}) for _ in range(2)]  # type: ignore[arg-type]
    iteration = done_by([*tasks, Task("steady_circle", FaultyCar(), FAST)], 3, lambda place, part: None)  # type: ignore[arg-type]
    assert next(iteration)[0] == 2
    workers = iteration.gi_frame.f_locals["workers"]  # type: ignore[attr-defined]
    assert sum(worker.process.is_alive() for worker in workers) == 3
    iteration.close()  # type: ignore[attr-defined]
    assert not any(worker.process.is_alive() for worker in workers)
