"""Runs as an experiment with a progress bar."""

import time as clock
from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from ali3.errors import UserError
from ali3.isolated_processes import Lost
from ali3.processes import store
from hosts.common.errors import FailedFmuError, HostError
from hosts.driving.co_simulation import columns_of, derive_columns, run
from hosts.driving.ground_marks import with_ground_marks
from hosts.driving.manoeuvre import Manoeuvre, with_names_of
from hosts.driving.pilots.pilot import Pilot
from hosts.driving.recorded_rows import read_rows
from hosts.driving.result import Result
from hosts.driving.simulated_fmu import SimulatedFmu
from hosts.experiment.experiment import Experiment
from hosts.fmu.fmu_source import FmuSource
from hosts.fmu.own_process import files_of_drives


@dataclass(frozen=True)
class Drive:
    """A manoeuvre and how it is driven."""

    manoeuvre: Manoeuvre
    step: float
    """Communication step, s."""
    driver: Pilot | None = None
    every: int = 1
    """Steps from row to row."""


_Refusal: TypeAlias = tuple[str, int]
"""Message and exit code of an error."""


@dataclass(frozen=True)
class _DriveTask:
    """The task of a process that makes drives."""

    source: FmuSource

    def __call__(self, drive: Drive, tell: Callable[[float], None]) -> Result | _Refusal:
        try:
            with self.source.opened() as fmu:
                result = run(
                    fmu, drive.manoeuvre, drive.step, drive.driver, tell, every=drive.every, last=True, file=store()
                )
        except UserError as error:  # an exception would end the other drives
            return str(error), error.status
        return replace(result, values=result.values[:0])  # rows are in the store of the process


def run_with_bar(
    fmu: SimulatedFmu, manoeuvre: Manoeuvre, step: float, driver: Pilot | None = None, every: int = 1
) -> Result:
    """One run of `runs_with_bar`.

    Raises `HostError`: the FMU cannot make the drive; `FailedFmuError`: its process has ended before the first row.
    """
    ((_, result),) = runs_with_bar(fmu, [Drive(manoeuvre, step, driver, every)])
    if isinstance(result, HostError):
        raise result
    return result


def runs_with_bar(
    fmu: SimulatedFmu, drives: Sequence[Drive], jobs: int = 1
) -> Generator[tuple[int, Result | HostError]]:
    """Number and result of `run` for each drive, with ground marks and a progress bar on the terminal.

    The last step of a drive always has a row. If a process ends, its rows are the result, or an error without rows; an
    error of one drive does not end the others. `fmu`: is not loaded here; `jobs`: number of processes.
    """
    experiment: Experiment[Drive, Result | _Refusal] = Experiment(
        fmu.path.stem,
        _DriveTask(FmuSource.of(fmu)),
        Result | _Refusal,
        lambda drive: f"{fmu.path.stem}, {drive.manoeuvre.name}",
        files_of_drives(fmu.path, [drive.manoeuvre.start for drive in drives]),
        lambda drive: max(1, round(drive.manoeuvre.stop_time / drive.step)),
        finish=partial(_result_with_rows, fmu),
    )
    begin = clock.perf_counter()
    with closing(experiment.results(drives, experiment.pool(jobs))) as results:
        for number, drive, outcome in results:
            result: Result | HostError
            if isinstance(outcome, Lost):
                result = _partial_result(fmu, drive, outcome, clock.perf_counter() - begin)
            elif isinstance(outcome, tuple):
                result = _host_error(*outcome)
            else:
                result = outcome
            if isinstance(result, Result):
                derive_columns(result, fmu, drive.every > 1)
                result = with_ground_marks(result, drive.driver)
            yield number, result
            begin = clock.perf_counter()


def _result_with_rows(
    fmu: SimulatedFmu, drive: Drive, result: Result | _Refusal | None, file: Path
) -> Result | _Refusal | NDArray[np.float64]:
    """The result with its rows, or an error; only the rows if the process has ended."""
    if isinstance(result, tuple):
        return result
    rows = read_rows(file, len(_column_names(fmu, drive)))
    return rows if result is None else replace(result, values=rows[: len(result.time)])


def _host_error(message: str, status: int) -> HostError:
    error = HostError(message)
    error.status = status
    return error


def _column_names(fmu: SimulatedFmu, drive: Drive) -> list[str]:
    return [name for names in columns_of(fmu, with_names_of(drive.manoeuvre, fmu.variables)) for name in names]


def _partial_result(fmu: SimulatedFmu, drive: Drive, lost: Lost, wall: float) -> Result | FailedFmuError:
    """The recorded part of a run whose process has ended, or an error without rows. `wall`: wall time, s."""
    rows, interval, names = lost.kept, drive.step * drive.every, _column_names(fmu, drive)
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
