"""``ali3 check FMU --reference CSV|DIR``: an FMU against tables of reference results."""

from __future__ import annotations

import fnmatch
import math
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ali3.columns import in_columns
from ali3.errors import UserError
from ali3.tables import TextTable
from hosts.check.junit import Case
from hosts.common.errors import HostError
from hosts.common.options import Wishes
from hosts.driving.driver import driver_of
from hosts.driving.manoeuvre import Manoeuvre, with_names_of
from hosts.driving.manoeuvre_settings import set_in
from hosts.driving.manoeuvre_table import read_table
from hosts.driving.result import Result
from hosts.driving.run_checks import check_columns
from hosts.driving.run_record import record_of
from hosts.driving.run_with_bar import run_with_bar
from hosts.fmu.fmu import Fmu
from hosts.recordings.load_manoeuvre import load_manoeuvre

BOUND = 0.01
"""Largest error of a signal over its size, unless another is given."""
_WORST = 10
_DIAGNOSTICS = "solver."
# Of a signal that hardly moves, the least size: shares of its largest value, whose digits a table cuts, and of its
# nominal value.
_OF_VALUE, _OF_NOMINAL = 1e-3, 1e-4
# Of a communication step by which the time of a row may miss a communication point.
_ROUND_OFF = 1e-4


@dataclass(frozen=True)
class Deviation:
    """How far a signal is from its reference."""

    name: str
    unit: str
    error: float
    """The largest, in that unit."""
    at: float
    """Its time, s."""
    size: float
    """Of the signal: the range of the reference, or a thousandth of its largest value, or a millionth of the nominal
    value, whichever is largest."""
    bound: float
    """Largest share of the size that is allowed."""

    @property
    def share(self) -> float:
        """Error over size."""
        return self.error / self.size

    @property
    def good(self) -> bool:
        """Whether it is within its bound; what is no number is not."""
        return self.share <= self.bound

    @property
    def words(self) -> tuple[str, str, str, str]:
        """The error, its time, its share and the bound."""
        unit = "" if self.unit == "1" else f" {self.unit}"
        return f"{self.error:.3g}{unit}", f"{self.at:g} s", f"{100.0 * self.share:.2g} %", f"{100.0 * self.bound:g} %"

    def case(self, reference: str) -> Case:
        """The result as a case of a JUnit file."""
        error, at, share, bound = self.words
        words = f"largest error {error} at {at}, {share} of its range; the bound is {bound}"
        return Case(reference, self.name, "good" if self.good else "bad", words)


def bounded(name: str, bounds: Sequence[tuple[str, float]]) -> float:
    """The bound of a signal: the last whose pattern fits."""
    return next((bound for pattern, bound in reversed(bounds) if fnmatch.fnmatchcase(name, pattern)), BOUND)


def deviations(
    fmu: Fmu,
    result: Result,
    times: NDArray[np.float64],
    columns: Mapping[str, NDArray[np.float64]],
    bounds: Sequence[tuple[str, float]] = (),
) -> list[Deviation]:
    """Errors of outputs at the times of a reference, the worst against its bound first.

    Parameters
    ----------
    fmu : Fmu
        Of the result; angles that differ by whole turns are the same.
    result : Result
        With a row at each of the times, up to its end.
    times : ndarray of shape (n,)
        s, not decreasing; of rows of one time the first counts.
    columns : mapping of str to ndarray of shape (n,)
        Outputs by name.
    bounds : sequence of (str, float)
        Patterns of names with bounds; the last that fits counts.
    """
    used = np.flatnonzero(np.diff(times, prepend=-math.inf) > 0.0)
    step = result.time[1] - result.time[0] if len(result.time) > 1 else 1.0
    rows = np.round(times[used] / step).astype(int)
    used, rows = used[rows < len(result.time)], rows[rows < len(result.time)]
    found = []
    for name, values in columns.items():
        wanted, unit = values[used], result.units[name]
        gap = result[name][rows] - wanted
        if unit == "rad":
            gap -= 2.0 * math.pi * np.round(gap / (2.0 * math.pi))
        error = np.where(np.isnan(gap), math.inf, np.abs(gap))
        worst = int(np.argmax(error))
        nominal = abs(float(fmu.variables[name].nominal or 1.0))
        size = max(float(np.ptp(wanted)), _OF_VALUE * float(np.abs(wanted).max()), _OF_NOMINAL * nominal)
        found.append(Deviation(name, unit, float(error[worst]), float(times[used][worst]), size, bounded(name, bounds)))
    return sorted(found, key=lambda d: -d.share / d.bound)


def check_references(
    path: Path, place: Path, cases: list[Case], bounds: Sequence[tuple[str, float]], **how: Any
) -> int:
    """Compare an FMU with a table, or with all tables in a folder, by name.

    Parameters
    ----------
    cases : list of Case
        Takes what was found, also before an error.
    bounds : sequence of (str, float)
        See `deviations`; each fits an output of one of the tables.
    **how
        Of `check_reference`.

    Returns
    -------
    int
        Exit code: 0 if all are within their bounds and no step was refused.

    Raises
    ------
    HostError
        There is no table, or no output that a bound fits; or the first of what `check_reference` raises, when all
        tables have been tried.
    """
    files = sorted(place.glob("*.csv")) if place.is_dir() else [place]
    if not files:
        raise HostError(f"There is no table (.csv) in the folder {place}.")
    errors = []
    for file in files:
        try:
            cases += check_reference(path, file, bounds=bounds, **how)
        except UserError as error:
            cases.append(Case(file.stem, "comparison", "error", str(error)))
            errors.append(error)
            if len(files) > 1:
                print(f"BAD   {error}")
    names = [case.name for case in cases if case.name != "run" and case.verdict in ("good", "bad")]
    for pattern, _ in bounds:
        if not errors and not fnmatch.filter(names, pattern):
            raise HostError(f"--bound {pattern}: {place} has no such output of {path.name}.")
    if errors:
        raise errors[0]
    return int(any(case.verdict == "bad" for case in cases))


def check_reference(
    path: Path,
    file: Path,
    manoeuvre: str | None,
    step: float | None,
    fidelity: float | None,
    wishes: Wishes,
    bounds: Sequence[tuple[str, float]],
) -> list[Case]:
    """Run an FMU as its reference was, and print how far its outputs are from it.

    Parameters
    ----------
    file : Path
        Table with a column time. Columns that are inputs or tunable parameters of the FMU drive it, as
        `hosts.driving.manoeuvre_table.read_table` says; those that are outputs are compared, `solver.*` where a bound
        names them.
    manoeuvre : str, optional
        What drives it in place of columns of the table.
    step : float, optional
        Communication step, s; by default that of the record beside the table, else of the FMU, else what divides the
        distance of the rows.
    bounds : sequence of (str, float)
        See `deviations`.

    Returns
    -------
    list of Case
        The run, and each signal.

    Raises
    ------
    HostError
        The table has no output of the FMU, or times that are no communication points.
    """
    begin = time.perf_counter()
    with Fmu(path) as fmu:
        driven, times, columns, left = _read(fmu, file, manoeuvre)
        driven = with_names_of(driven, fmu.variables)
        check_columns(fmu, driven)
        driver = driver_of(fmu, driven)
        driven, settings = set_in(fmu, driven, wishes, fidelity)
        driven = replace(driven, stop_time=float(times[-1]))
        step = _step(fmu, driven, times, file) if step is None else step
        _check_times(times, step, file)
        result = run_with_bar(fmu, driven, step, driver)
        if not any(pattern.startswith(_DIAGNOSTICS) for pattern, _ in bounds):  # of steps, not of the car
            columns = {n: values for n, values in columns.items() if not n.startswith(_DIAGNOSTICS)} or columns
        found = deviations(fmu, result, times, columns, bounds)
    for name, words in settings.rows():
        print(f"{name}  {words}")
    _print_table(found[:_WORST])
    if left:
        print(f"not compared, for {path.name} has no such output: {', '.join(left)}")
    if times[0] > 0.0 and manoeuvre is None:
        print(f"{file} begins at {times[0]:g} s: its first row drives the FMU from 0 s, and it is compared from there")
    if result.late:
        print(f"inputs that were held, and late by {500.0 * step:.3g} ms on average: {', '.join(result.late)}")
    for missed in result.missed:
        print(": ".join(missed))
    for message in dict.fromkeys(result.messages):
        print(f"FMU: {message}")
    bad = sum(not d.good for d in found)
    share = "" if bounds else f"; the bound is {100.0 * BOUND:g} % of the range of each, --bound NAME=SHARE sets others"
    print(
        f"\n{path} against {file}, {len(found)} signals up to {result.time[-1]:g} s in steps of {step:g} s: "
        f"{'all within their bounds' if not bad else f'{bad} beyond their bounds'}{share}"
    )
    ended = f"up to {result.time[-1]:g} s in steps of {step:g} s"
    if result.failed_steps:
        ended = f"The step at {result.time[-1]:g} s was refused; the reference goes on to {times[-1]:g} s."
        print(ended)
    run = Case(file.stem, "run", "bad" if result.failed_steps else "good", ended, time.perf_counter() - begin)
    missing = [Case(file.stem, name, "skipped", f"{path.name} has no such output") for name in left]
    return [run, *(deviation.case(file.stem) for deviation in found), *missing]


def _read(
    fmu: Fmu, file: Path, manoeuvre: str | None
) -> tuple[Manoeuvre, NDArray[np.float64], dict[str, NDArray[np.float64]], list[str]]:
    """What drives the FMU, times and outputs of the table, and columns that the FMU does not have."""
    drives, outputs = {*fmu.names("input"), *fmu.tunable}, set(fmu.names("output"))
    if manoeuvre is None:
        driven = read_table(file, drives)
    else:
        driven = load_manoeuvre(manoeuvre)
        driven = replace(driven, step=record_of(file).step or driven.step)
    table = TextTable(file, HostError)
    values = table.values()
    columns = {n: values[:, k] for k, n in enumerate(table.names) if n in outputs}
    if not columns:
        raise HostError(f"{file} has no column that is an output of {fmu.path.name}; there is nothing to compare.")
    if not values[-1, 0] > 0.0:
        raise HostError(f"{file} ends at {values[-1, 0]:g} s; a reference goes on after 0 s.")
    return driven, values[:, 0], columns, [n for n in table.names[1:] if n not in drives | outputs]


def _step(fmu: Fmu, driven: Manoeuvre, times: NDArray[np.float64], file: Path) -> float:
    """The communication step of the record or of the FMU, made such that the rows are communication points."""
    experiment = fmu.description.defaultExperiment
    usual = float(experiment.stepSize) if experiment is not None and experiment.stepSize else 0.01
    step, between = driven.step or usual, np.diff(times)
    apart = float(np.median(between[between > 0.0])) if (between > 0.0).any() else float(times[-1])
    return apart / max(1, math.ceil(apart / step - _ROUND_OFF))


def _check_times(times: NDArray[np.float64], step: float, file: Path) -> None:
    if not step > 0.0:
        raise HostError(f"The step is {step:g} s; it must be positive.")
    if times[0] < 0.0:
        raise HostError(f"{file} begins at {times[0]:g} s; a run begins at 0: add {-times[0]:g} s to all its times.")
    off = np.abs(times / step - np.round(times / step))
    worst = int(np.argmax(off))
    if off[worst] > _ROUND_OFF:
        raise HostError(
            f"{file} has a row at {times[worst]:.9g} s, which is no communication point of a run from 0 "
            f"s in steps of {step:g} s; --step gives one that divides all times."
        )


def _print_table(found: Sequence[Deviation]) -> None:
    rows = [("", "signal", "largest error", "at", "of its range", "bound")]
    for d in found:
        rows.append((" ok " if d.good else "BAD ", d.name, *d.words))
    print("\n".join(in_columns(rows)))
