"""Stores the records of finished tests in the folder of results, so that the same command resumes with the others."""

from dataclasses import replace

import numpy as np

from hosts.catalogue.record import TestRecord
from hosts.catalogue.task import Task, run_file
from hosts.driving.result import Result
from hosts.experiment.run_key import run_key
from hosts.experiment.store import ResultStore
from hosts.fmu.own_process import files_of


def digest(task: Task) -> str:
    """A hash of everything on which the outcome of a task depends."""
    car = task.car
    content = task.test, car.fmu.digest, sorted(car.start.items()), car.step, sorted(task.settings.items())
    return run_key(car.path, *content, files=files_of(car.start))


def find_record(store: ResultStore[TestRecord], task: Task) -> TestRecord | None:
    """The stored record of a task; None: it was not done, its task has changed, or tables of its runs are missing."""
    record = store.find(_record_name(task), digest(task))
    return record if record is not None and _has_tables(task, list(record.runs)) else None


def store_record(store: ResultStore[TestRecord], task: Task, record: TestRecord) -> None:
    """Store the record of a task without the results of its runs, which have their own files."""
    empty_result = Result([], {}, np.zeros(0), np.zeros((0, 0)), 0.0, 0.0, 0, [])
    store.add(_record_name(task), digest(task), replace(record, runs=dict.fromkeys(record.runs, empty_result)))


def _record_name(task: Task) -> str:
    return f"{task.test}/{task.car.label}"


def _has_tables(task: Task, runs: list[str]) -> bool:
    if task.folder is None:
        return True
    return all((task.folder / run_file(task.test, task.car.label, run)).is_file() for run in runs)
