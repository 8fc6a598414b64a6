"""Tests that are done stay in the folder of the results, so that the same command goes on with the others."""

from __future__ import annotations

import hashlib
import json
from dataclasses import asdict
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from ali3.archives import LARGEST_ARCHIVE
from ali3.errors import FileError
from ali3.files import write_text
from ali3.json_reading import read_json
from ali3.reading import read_bytes
from hosts.catalogue.record import Line, Plot, TestRecord
from hosts.catalogue.task import Task, run_file
from hosts.common.errors import HostError
from hosts.common.program import program_digest
from hosts.driving.result import Result
from hosts.measures.measure import Limit, Measure


def digest(task: Task) -> str:
    """A hash of all that the outcome of a task depends on: the FMU, what is set, the test, and the program."""
    car = task.car
    told = (task.test, repr(car.aliases), sorted(car.start.items()), car.step, sorted(task.settings.items()))
    state = car.path.stat()
    parts = (_file_hash(car.path, state.st_size, state.st_mtime_ns), _hash(repr(told).encode()))
    return _hash(b"".join((*parts, _hash(program_digest().encode())))).hex()


@cache
def _file_hash(path: Path, size: int, changed: int) -> bytes:
    """Once for all tests of an FMU; its size and the time of its last change, ns, tell another file of its name."""
    return _hash(read_bytes(path, LARGEST_ARCHIVE, HostError))


def _hash(content: bytes) -> bytes:
    return hashlib.sha256(content).digest()


def keep(task: Task, record: TestRecord, out: Path) -> None:
    """Write what a task has yielded into the folder of the results, but the tables of its runs."""
    content = {
        "digest": digest(task),
        "measures": [asdict(m) for m in record.measures],
        "plots": [_of_plot(plot) for plot in record.plots],
        "runs": list(record.runs),
        "notes": list(record.notes),
    }
    write_text(_file(task, out), json.dumps(content))


def kept(task: Task, out: Path) -> TestRecord | None:
    """What the same task has yielded before; None where it was not done, was another, or its file is damaged."""
    file = _file(task, out)
    if not file.is_file():
        return None
    try:
        content = read_json(file, finite=False)
        if content["digest"] != digest(task):
            return None
        measures, plots = [_measure(m) for m in content["measures"]], [_plot(plot) for plot in content["plots"]]
        runs = dict.fromkeys(content["runs"], Result([], {}, np.zeros(0), np.zeros((0, 0)), 0.0, 0.0, 0, []))
        notes = content["notes"]
    except (FileError, KeyError, TypeError, ValueError):
        return None
    return TestRecord(measures, plots, runs, notes) if _has_tables(task, list(runs)) else None


def _file(task: Task, out: Path) -> Path:
    return out / "kept" / run_file(task.test, task.car.label, "").with_suffix(".json").relative_to("runs")


def _has_tables(task: Task, runs: list[str]) -> bool:
    if task.folder is None:
        return True
    return all((task.folder / run_file(task.test, task.car.label, run)).is_file() for run in runs)


def _of_plot(plot: Plot) -> dict[str, Any]:
    lines = [{"label": line.label, "x": line.x.tolist(), "y": line.y.tolist()} for line in plot.lines]
    return {**{k: v for k, v in vars(plot).items() if k != "lines"}, "lines": lines}


def _plot(content: dict[str, Any]) -> Plot:
    lines = [
        Line(line["label"], np.array(line["x"], dtype=np.float64), np.array(line["y"], dtype=np.float64))
        for line in content["lines"]
    ]
    return Plot(**{**content, "lines": lines})


def _measure(content: dict[str, Any]) -> Measure:
    limit = None if content["limit"] is None else Limit(**content["limit"])
    return Measure(**{**content, "limit": limit})
