"""Keeps the records of finished tests in the folder of results, so that the same command resumes with the others."""

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
    content = task.test, car.fmu.digest, sorted(car.start.items()), car.step, sorted(task.settings.items())
    return run_key(car.path, *content, files=files_of(car.start))


def find(kept: ResultStore[TestRecord], task: Task) -> TestRecord | None:
    """The record of the same task from before; None: it was not done, has changed, or tables of its runs are gone."""
    record = kept.find(_name(task), digest(task))
    return record if record is not None and _has_tables(task, list(record.runs)) else None


def keep(kept: ResultStore[TestRecord], task: Task, record: TestRecord) -> None:
    """Keep the record of a task, without the tables of its runs, which have files of their own."""
    nothing = Result([], {}, np.zeros(0), np.zeros((0, 0)), 0.0, 0.0, 0, [])
    kept.add(_name(task), digest(task), replace(record, runs=dict.fromkeys(record.runs, nothing)))


def _name(task: Task) -> str:
    return f"{task.test}/{task.car.label}"


def _has_tables(task: Task, runs: list[str]) -> bool:
    if task.folder is None:
        return True
    return all((task.folder / run_file(task.test, task.car.label, run)).is_file() for run in runs)
