"""One test of one car as the task of a worker process, and its stored record, by which the same command resumes."""

import json
import re
import time
import traceback
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeAlias

import numpy as np

from ali3.errors import UserError
from ali3.files import write_text
from hosts.catalogue.car import TestedCar
from hosts.catalogue.execution import Reason, perform
from hosts.catalogue.registry import standard_test
from hosts.catalogue.standard_test import TestRecord
from hosts.driving.result import Result
from hosts.experiment.store import ResultStore, run_key
from hosts.fmu.own_process import files_of
from hosts.run.result_files import write_csv

Outcome: TypeAlias = "TestRecord | Reason"
"""The record of a test, or the reason why it was not done."""
_REPORT_INTERVAL = 0.1  # s between reports of the progress


@dataclass(frozen=True)
class Task:
    """One test of one car, for a worker process."""

    test: str
    car: TestedCar
    settings: Mapping[str, float]
    folder: Path | None = None
    """Folder of the tables of runs; None: none are written."""


def perform_task(task: Task, progress: Callable[[float], None]) -> Outcome:
    """Run the test of a task; an error becomes its outcome.

    `progress`: called with the fraction done, 0 to 1, at most ten times a second.
    """
    last = -1.0

    def report(done: float) -> None:
        nonlocal last
        now = time.monotonic()
        if now - last >= _REPORT_INTERVAL:
            last = now
            progress(done)

    try:
        return perform(standard_test(task.test), task.car, task.settings, report)
    except UserError as error:
        return str(error)
    except MemoryError:
        return "The memory was not enough."
    except Exception as error:
        frame = traceback.extract_tb(error.__traceback__)[-1]
        return f"The test ended with an internal error: {error!r} in {Path(frame.filename).name}, line {frame.lineno}."


def write_runs(task: Task, record: TestRecord) -> None:
    """Write a table of each run, and a file for `ali3 view` beside it, if the task has a folder."""
    if task.folder is None:
        return
    for name, result in record.runs.items():
        file = task.folder / run_file(task.test, task.car.label, name)
        write_csv(result, file)
        fmu_values = task.car.fmu.fmu_values(result.start)
        settings = [{"name": variable, "new": value} for variable, value in fmu_values.items()]
        view_record = {
            "fmu": str(task.car.path),
            "token": task.car.facts.token,
            "set": settings,
            "marks": result.marks,
            "names": task.car.fmu.of_record,
        }
        write_text(file.with_suffix(".json"), json.dumps(view_record, ensure_ascii=False) + "\n")


def run_file(test: str, label: str, run: str) -> Path:
    """Path of the table of a run, relative to the folder of the results."""
    return Path("runs", test, f"{_file_stem(label)}_{_file_stem(run)}.csv")


def _file_stem(name: str) -> str:
    return re.sub(r"[^\w.+-]+", "_", name).strip("_")


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
