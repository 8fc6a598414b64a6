"""Runs that a person waits for and looks at, as an experiment."""

from __future__ import annotations

import time as clock
from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ali3.isolated import Lost
from ali3.processes import store
from hosts.common.errors import FailedFmuError
from hosts.driving.co_simulation import columns_of, run
from hosts.driving.derived_columns import derive_columns
from hosts.driving.ground_marks import marked
from hosts.driving.manoeuvre import Manoeuvre, with_names_of
from hosts.driving.pilots.pilot import Pilot
from hosts.driving.recorded_rows import kept_rows
from hosts.driving.result import Result
from hosts.driving.simulated_fmu import SimulatedFmu
from hosts.experiment.experiment import Experiment
from hosts.fmu.fmu_source import FmuSource
from hosts.fmu.own_process import files_of_drives


@dataclass(frozen=True)
class Drive:
    """A manoeuvre that is driven."""

    manoeuvre: Manoeuvre
    step: float
    """Communication step, s."""
    driver: Pilot | None = None
    every: int = 1
    """Steps from row to row."""


@dataclass(frozen=True)
class _Driving:
    """Drives as work for a process."""

    source: FmuSource

    def __call__(self, drive: Drive, tell: Callable[[float], None]) -> Result:
        with self.source.opened() as fmu:
            result = run(
                fmu, drive.manoeuvre, drive.step, drive.driver, tell, every=drive.every, last=True, kept=store()
            )
        return replace(result, values=result.values[:0])  # the rows are in the store


def run_with_bar(
    fmu: SimulatedFmu, manoeuvre: Manoeuvre, step: float, driver: Pilot | None = None, every: int = 1
) -> Result:
    """`run` as `runs_with_bar` makes it. Raises `FailedFmuError`: its process has ended before the first row."""
    ((_, result),) = runs_with_bar(fmu, [Drive(manoeuvre, step, driver, every)])
    if isinstance(result, FailedFmuError):
        raise result
    return result


def runs_with_bar(
    fmu: SimulatedFmu, drives: Sequence[Drive], jobs: int = 1
) -> Generator[tuple[int, Result | FailedFmuError]]:
    """`run` for each drive, with a progress bar on the terminal and with marks on the ground; its number and result.

    The last step of a drive always has a row. `fmu`: is not loaded here; where a process ends, the rows until then are
    the result, or an error where there are none; `jobs`: processes.
    """
    experiment: Experiment[Drive, Result] = Experiment(
        fmu.path.stem,
        _Driving(FmuSource.of(fmu)),
        Result,
        lambda drive: f"{fmu.path.stem}, {drive.manoeuvre.name}",
        files_of_drives(fmu.path, [drive.manoeuvre.start for drive in drives]),
        lambda drive: max(1, round(drive.manoeuvre.stop_time / drive.step)),
        finish=partial(_with_rows, fmu),
    )
    begin = clock.perf_counter()
    with closing(experiment.results(drives, experiment.pool(jobs))) as results:
        for number, drive, done in results:
            result = _rest(fmu, drive, done, clock.perf_counter() - begin) if isinstance(done, Lost) else done
            if isinstance(result, Result):
                derive_columns(result, fmu, drive.every > 1)
                result = marked(result, drive.driver)
            yield number, result
            begin = clock.perf_counter()


def _with_rows(fmu: SimulatedFmu, drive: Drive, result: Result | None, place: Path) -> Result | NDArray[np.float64]:
    """The result with its rows; of a run whose process has ended, the rows."""
    rows = kept_rows(place, len(_names(fmu, drive)))
    return rows if result is None else replace(result, values=rows[: len(result.time)])


def _names(fmu: SimulatedFmu, drive: Drive) -> list[str]:
    return [name for part in columns_of(fmu, with_names_of(drive.manoeuvre, fmu.variables)) for name in part]


def _rest(fmu: SimulatedFmu, drive: Drive, lost: Lost, wall: float) -> Result | FailedFmuError:
    """What is there of a run whose process has ended."""
    rows, interval, names = lost.kept, drive.step * drive.every, _names(fmu, drive)
    if not len(rows):
        return FailedFmuError(f"The process of the FMU {lost.how}; no row was recorded.")
    return Result(
        names,
        {name: fmu.variables[name].unit or "1" for name in names},
        interval * np.arange(len(rows), dtype=np.float64),
        rows,
        wall,
        interval * max(0, len(rows) - 1),
        1,
        [],
        start=dict(drive.manoeuvre.start),
        ended=f"The process of the FMU {lost.how}; {len(rows)} rows were kept.",
    )
