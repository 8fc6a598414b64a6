"""``ali3 check FMU --reference CSV|DIR``: an FMU against tables of reference results."""

from __future__ import annotations

import fnmatch
import math
import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ali3.columns import in_columns, some_of
from ali3.errors import UserError
from ali3.tables import TextTable
from hosts.check.deviations import BOUND, Deviation, deviations, remedies
from hosts.check.junit import Case
from hosts.common.errors import HostError
from hosts.common.options import Wishes
from hosts.driving.driver import driver_of
from hosts.driving.manoeuvre import Manoeuvre, with_names_of
from hosts.driving.manoeuvre_settings import set_in
from hosts.driving.manoeuvre_table import check_begin, read_table
from hosts.driving.run_checks import check_columns
from hosts.driving.run_record import record_of
from hosts.driving.run_with_bar import run_with_bar
from hosts.fmu.fmu import Fmu
from hosts.fmu.variables import default_step
from hosts.recordings.load_manoeuvre import load_manoeuvre

_WORST = 10
_DIAGNOSTICS = "solver."
# Of a communication step by which the time of a row may miss a communication point.
_ROUND_OFF = 1e-4


def check_references(
    path: Path, place: Path, cases: list[Case], bounds: Sequence[tuple[str, float]], **how: Any
) -> int:
    """Compare an FMU with a table, or with all tables in a folder, by name.

    `cases`: takes what was found, also before an error; `bounds`: see `deviations`; each fits an output of one of the
    tables; `how`: of `check_reference`. Result: exit code: 0 if all are within their bounds and no step was refused.
    Raises `HostError`: there is no table, or no output that a bound fits; or the first of what `check_reference`
    raises, when all tables have been tried.
    """
    files = sorted(place.glob("*.csv")) if place.is_dir() else [place]
    if not files:
        raise HostError(f"There is no table (.csv) in the folder {place}.")
    for pattern, share in bounds:
        if not 0.0 <= share < math.inf:
            raise HostError(f"--bound {pattern} is {share:g}; a bound is a share of the range, from 0 on.")
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
        nominals = {n: abs(float(fmu.variables[n].nominal or 1.0)) for n in columns}
        found = deviations(nominals, result, times, columns, bounds)
    for name, words in settings.rows():
        print(f"{name}  {words}")
    _print_table(found[:_WORST])
    bad = [d for d in found if not d.good]
    for words in remedies(result, times, columns, bad):
        print(words)
    if still := [n for n in fmu.names("input") if n not in {*driven.inputs, *driven.start} and manoeuvre is None]:
        print(f"inputs without a column, which keep their start values: {some_of(still)}")
    apart = float(np.diff(times).max(initial=0.0))
    if bad and manoeuvre is None and driven.inputs and apart > (1.0 + _ROUND_OFF) * step:
        print(f"between rows, up to {apart:g} s apart, inputs go straight: did those of the reference do so?")
    if left:
        print(f"not compared, for {path.name} has no such output: {', '.join(left)}")
    if times[0] > 0.0 and manoeuvre is None:
        print(f"{file} begins at {times[0]:g} s and is compared from there")
    if result.late:
        print(f"inputs that were held, and late by {500.0 * step:.3g} ms on average: {', '.join(result.late)}")
    for missed in result.missed:
        print(": ".join(missed))
    for message in dict.fromkeys(result.messages):
        print(f"FMU: {message}")
    if wrong := result.not_finite():
        print(wrong)
    share = "" if bounds else f"; the bound is {100.0 * BOUND:g} % of the range of each, --bound NAME=SHARE sets others"
    print(
        f"\n{path} against {file}, {len(found)} signals up to {result.time[-1]:g} s in steps of {step:g} s: "
        f"{'all within their bounds' if not bad else f'{len(bad)} beyond their bounds'}{share}"
    )
    ended = f"up to {result.time[-1]:g} s in steps of {step:g} s"
    if result.refusal:
        ended = f"The reference goes on to {times[-1]:g} s, but {result.refusal}."
        print(ended)
    elif wrong:
        ended = wrong
    run = Case(file.stem, "run", "good" if result.is_good else "bad", ended, time.perf_counter() - begin)
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
    table = TextTable(file, HostError, known=("time",))
    values = table.values()
    columns = {n: values[:, k] for k, n in enumerate(table.names) if n in outputs}
    if not columns:
        raise HostError(f"{file} has no column that is an output of {fmu.path.name}; there is nothing to compare.")
    check_begin(values[0, 0], values[-1, 0], file)
    if not values[-1, 0] > 0.0:
        raise HostError(f"{file} ends at {values[-1, 0]:g} s; a reference goes on after 0 s.")
    return driven, values[:, 0], columns, [n for n in table.names[1:] if n not in drives | outputs]


def _step(fmu: Fmu, driven: Manoeuvre, times: NDArray[np.float64], file: Path) -> float:
    """The communication step of the record or of the FMU, made such that the rows are communication points."""
    step, between = driven.step or default_step(fmu.description), np.diff(times)
    apart = float(np.median(between[between > 0.0])) if (between > 0.0).any() else float(times[-1])
    return apart / max(1, math.ceil(apart / step - _ROUND_OFF))


def _check_times(times: NDArray[np.float64], step: float, file: Path) -> None:
    if not step > 0.0:
        raise HostError(f"The step is {step:g} s; it must be positive.")
    off = np.abs(times / step - np.round(times / step))
    worst = int(np.argmax(off))
    if off[worst] > _ROUND_OFF:
        raise HostError(
            f"{file} has a row at {times[worst]:.9g} s, which is no communication point of a run from 0 "
            f"s in steps of {step:g} s; --step gives one that divides all times."
        )


def _print_table(found: Sequence[Deviation]) -> None:
    rows = [("", "signal", "largest error", "at", "its range", "share of it", "bound")]
    for d in found:
        rows.append((" ok " if d.good else "BAD ", d.name, *d.words))
    print("\n".join(in_columns(rows)))
