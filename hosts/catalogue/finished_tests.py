"""Tests that are done stay in the folder of the results, so that the same command goes on with the others."""

from dataclasses import replace

import numpy as np

from hosts.catalogue.record import TestRecord
from hosts.catalogue.task import Task, run_file
from hosts.driving.result import Result
from hosts.experiment.run_key import run_key
from hosts.experiment.store import ResultStore
from hosts.fmu.own_process import files_of


def digest(task: Task) -> str:
    """A hash of all that the outcome of a task depends on."""
    car = task.car
    key_parts = task.test, car.fmu.digest, sorted(car.start.items()), car.step, sorted(task.settings.items())
    return run_key(car.path, *key_parts, files=files_of(car.start))


def find(kept: ResultStore[TestRecord], task: Task) -> TestRecord | None:
    """What the same task has yielded before; None where it was not done, was another, or its tables have gone."""
    record = kept.find(_name(task), digest(task))
    return record if record is not None and _has_tables(task, list(record.runs)) else None


def keep(kept: ResultStore[TestRecord], task: Task, record: TestRecord) -> None:
    """Keep what a task has yielded, but the tables of its runs."""
    nothing = Result([], {}, np.zeros(0), np.zeros((0, 0)), 0.0, 0.0, 0, [])
    kept.add(_name(task), digest(task), replace(record, runs=dict.fromkeys(record.runs, nothing)))


def _name(task: Task) -> str:
    return f"{task.test}/{task.car.label}"


def _has_tables(task: Task, runs: list[str]) -> bool:
    if task.folder is None:
        return True
    return all((task.folder / run_file(task.test, task.car.label, run)).is_file() for run in runs)
