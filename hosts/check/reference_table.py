"""Tables of reference results, and the runs of an FMU that are compared with them."""

import math
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ali3.tables import TextTable
from hosts.common.errors import HostError
from hosts.common.options import FmuOptions
from hosts.driving.driver import driver_of
from hosts.driving.manoeuvre import Manoeuvre, with_names_of
from hosts.driving.manoeuvre_settings import apply_settings
from hosts.driving.manoeuvre_table import check_begin, read_table
from hosts.driving.run_checks import check_columns
from hosts.driving.run_record import record_of
from hosts.driving.runs_with_progress import Drive
from hosts.fmu.fmu import Fmu
from hosts.fmu.settings import Settings
from hosts.fmu.variables import default_step
from hosts.recordings.load_manoeuvre import load_manoeuvre

ROUND_OFF = 1e-4
"""Tolerance of the time between a row and a communication point, part of a communication step."""


@dataclass(frozen=True)
class ReferenceOptions:
    """Options for the runs that are compared with references."""

    manoeuvre: str | None
    """Name or file of a manoeuvre that drives the FMU instead of columns of the table."""
    step: float | None
    """Communication step, s; None: that of the record beside a table, otherwise of the FMU, shortened such that rows
    are communication points."""
    fidelity: float | None
    fmu_options: FmuOptions
    """Parameters and start values."""


@dataclass(frozen=True)
class Reference:
    """A table of reference results, and the run that is compared with it."""

    file: Path
    drive: Drive
    times: NDArray[np.float64]
    columns: dict[str, NDArray[np.float64]]
    """Outputs of the FMU by name."""
    missing_columns: list[str]
    """Columns that the FMU does not have."""
    settings: Settings


def read_reference(fmu: Fmu, file: Path, options: ReferenceOptions) -> Reference:
    """Read a table of reference results. Raises `HostError` if the FMU cannot be compared with it."""
    manoeuvre, times, columns, missing_columns = _read_table(fmu, file, options.manoeuvre)
    manoeuvre = with_names_of(manoeuvre, fmu.variables)
    check_columns(fmu, manoeuvre)
    driver = driver_of(fmu, manoeuvre)
    manoeuvre, settings = apply_settings(fmu, manoeuvre, options.fmu_options, options.fidelity)
    manoeuvre = replace(manoeuvre, stop_time=float(times[-1]))
    step = _communication_step(fmu, manoeuvre, times) if options.step is None else options.step
    _check_times(times, step, file)
    return Reference(file, Drive(manoeuvre, step, driver), times, columns, missing_columns, settings)


def _read_table(
    fmu: Fmu, file: Path, manoeuvre: str | None
) -> tuple[Manoeuvre, NDArray[np.float64], dict[str, NDArray[np.float64]], list[str]]:
    """The manoeuvre, times and outputs of the table, and columns that the FMU does not have."""
    drives, outputs = {*fmu.names("input"), *fmu.tunable}, set(fmu.names("output"))
    if manoeuvre is None:
        driven = read_table(file, drives)
    else:
        driven = load_manoeuvre(manoeuvre)
        driven = replace(driven, step=record_of(file).step or driven.step)
    table = TextTable(file, HostError, known=("time",))
    values = table.values()
    columns = {n: values[:, k] for k, n in enumerate(table.names) if n in outputs}
    if not columns:
        raise HostError(f"{file} has no column that is an output of {fmu.path.name}; there is nothing to compare.")
    check_begin(values[0, 0], values[-1, 0], file)
    if not values[-1, 0] > 0.0:
        raise HostError(f"{file} ends at {values[-1, 0]:g} s; a reference must end after 0 s.")
    return driven, values[:, 0], columns, [n for n in table.names[1:] if n not in drives | outputs]


def _communication_step(fmu: Fmu, manoeuvre: Manoeuvre, times: NDArray[np.float64]) -> float:
    """The communication step of the record or of the FMU, shortened such that rows are communication points."""
    step, intervals = manoeuvre.step or default_step(fmu.description), np.diff(times)
    interval = float(np.median(intervals[intervals > 0.0])) if (intervals > 0.0).any() else float(times[-1])
    return interval / max(1, math.ceil(interval / step - ROUND_OFF))


def _check_times(times: NDArray[np.float64], step: float, file: Path) -> None:
    if not step > 0.0:
        raise HostError(f"The step is {step:g} s; it must be positive.")
    off = np.abs(times / step - np.round(times / step))
    worst = int(np.argmax(off))
    if off[worst] > ROUND_OFF:
        raise HostError(
            f"{file} has a row at {times[worst]:.9g} s, which is not a communication point of a run from 0 "
            f"s in steps of {step:g} s; give a step that divides all times (--step)."
        )
