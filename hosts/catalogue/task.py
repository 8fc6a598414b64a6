"""One test of one car as the task of a worker process."""

import json
import re
import time
import traceback
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

from ali3.errors import UserError
from ali3.files import write_text
from hosts.catalogue.car import TestedCar
from hosts.catalogue.execution import Reason, perform
from hosts.catalogue.record import TestRecord
from hosts.catalogue.registry import standard_test
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
