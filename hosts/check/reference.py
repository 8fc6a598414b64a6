"""``ali3 check FMU --reference CSV|DIR``: an FMU against tables of reference results."""

import fnmatch
import math
from collections.abc import Generator, Iterable, Iterator, Sequence
from contextlib import ExitStack, closing
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from ali3.columns import in_columns, some_of
from ali3.errors import UserError
from ali3.tables import TextTable
from hosts.check.deviations import BOUND, Deviation, deviations, remedies
from hosts.check.verdict_files import Case
from hosts.common.errors import HostError
from hosts.common.options import FmuOptions
from hosts.driving.driver import driver_of
from hosts.driving.manoeuvre import Manoeuvre, digest, with_names_of
from hosts.driving.manoeuvre_settings import apply_settings
from hosts.driving.manoeuvre_table import check_begin, read_table
from hosts.driving.result import Result
from hosts.driving.run_checks import check_columns
from hosts.driving.run_record import record_of
from hosts.driving.runs_with_progress import Drive, runs_with_bar
from hosts.experiment.store import ResultStore, report_resumed, run_key
from hosts.fmu.fmu import Fmu
from hosts.fmu.own_process import files_of
from hosts.fmu.settings import Settings
from hosts.fmu.variables import default_step
from hosts.recordings.load_manoeuvre import load_manoeuvre

OUT = Path("out", "reference")
_MAX_PRINTED = 10
_DIAGNOSTICS = "solver."
_ROUND_OFF = 1e-4  # of a communication step, between the time of a row and a communication point

T = TypeVar("T")


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
class _Reference:
    """A table of reference results, and the run that is compared with it."""

    file: Path
    drive: Drive
    times: NDArray[np.float64]
    columns: dict[str, NDArray[np.float64]]
    """Outputs of the FMU by name."""
    missing_columns: list[str]
    """Columns that the FMU does not have."""
    settings: Settings


@dataclass(frozen=True)
class _Comparison:
    """The comparison of a run with a table."""

    lines: list[str]
    cases: list[Case]


def check_references(
    path: Path,
    tables: Path,
    cases: list[Case],
    bounds: Sequence[tuple[str, float]],
    options: ReferenceOptions,
    jobs: int,
    out: Path,
    again: bool = False,
) -> int:
    """Run an FMU with the inputs of its references, and print the deviations of its outputs.

    The result of each of several tables is stored until all are done, so that the same call resumes a stopped one.

    Parameters
    ----------
    tables : Path
        A table with a column time, or a folder of tables. Columns that are inputs or tunable parameters of the FMU
        drive it, see `hosts.driving.manoeuvre_table.read_table`; those that are outputs are compared, `solver.*` only
        if a bound names them.
    cases : list of Case
        Receives the run and the signals of each table, also before an error.
    bounds : sequence of (str, float)
        See `deviations`; each must fit an output of one of the tables.
    options : ReferenceOptions
        Options for the runs.
    jobs : int
        Tables compared at the same time.
    out : Path
        Folder of the stored results.
    again : bool
        Whether tables with a stored result are compared again.

    Returns
    -------
    int
        Exit code: 0 if all are within their bounds and no step was refused.

    Raises
    ------
    HostError
        There is no table, or a bound names no output of a table. Of errors of single tables the first is raised after
        all are done: a table has no output of the FMU, its times are not communication points, or the FMU does not
        start with its values.
    """
    files = sorted(tables.glob("*.csv")) if tables.is_dir() else [tables]
    if not files:
        raise HostError(f"There is no table (.csv) in the folder {tables}.")
    for pattern, share in bounds:
        if not 0.0 <= share < math.inf:
            raise HostError(f"--bound {pattern} is {share:g}; it must be a share of the range, 0 or more.")
    errors = list[UserError]()

    def add_error(file: Path, error: UserError) -> None:
        cases.append(Case(file.stem, "comparison", "error", str(error)))
        errors.append(error)
        if len(files) > 1:
            print(f"BAD   {file.name}: {error}")

    with ExitStack() as stack:
        fmu = stack.enter_context(Fmu(path))
        store = (
            stack.enter_context(ResultStore[_Comparison](out, _Comparison, "checks an FMU", again))
            if tables.is_dir()
            else None
        )
        references = []
        for file in files:
            try:
                references.append(_read_reference(fmu, file, options))
            except UserError as error:
                add_error(file, error)
        comparisons = stack.enter_context(
            closing(_comparisons(fmu, references, store, bounds, options.manoeuvre is None, jobs))
        )
        for reference, outcome in zip(references, in_order(comparisons), strict=True):
            if isinstance(outcome, HostError):
                add_error(reference.file, outcome)
            else:
                print("\n".join(outcome.lines), flush=True)
                cases += outcome.cases
        if store is not None:
            store.clear()
    names = [case.name for case in cases if case.name != "run" and case.verdict in ("good", "bad")]
    for pattern, _ in bounds:
        if not errors and not fnmatch.filter(names, pattern):
            raise HostError(f"--bound {pattern}: {tables} has no such output of {path.name}.")
    if errors:
        raise errors[0]
    return int(any(case.verdict == "bad" for case in cases))


def _comparisons(
    fmu: Fmu,
    references: Sequence[_Reference],
    store: ResultStore[_Comparison] | None,
    bounds: Sequence[tuple[str, float]],
    by_table: bool,
    jobs: int,
) -> Generator[tuple[int, _Comparison | HostError]]:
    """Number and comparison of each table: first the stored ones, then the others as they are done."""
    keys = [_key(fmu, reference, bounds) for reference in references]
    names = [reference.file.name for reference in references]
    stored = [None if store is None else store.find(*name_and_key) for name_and_key in zip(names, keys, strict=True)]
    present = [(number, outcome) for number, outcome in enumerate(stored) if outcome is not None]
    report_resumed(len(present), len(keys), "tables")
    yield from present
    pending = [number for number, outcome in enumerate(stored) if outcome is None]
    with closing(runs_with_bar(fmu, [references[number].drive for number in pending], jobs)) as results:
        for index, result in results:
            number = pending[index]
            if isinstance(result, HostError):
                yield number, result
                continue
            comparison = _compare(fmu, references[number], result, bounds, by_table)
            if store is not None:
                store.add(names[number], keys[number], comparison)
            yield number, comparison


def _key(fmu: Fmu, reference: _Reference, bounds: Sequence[tuple[str, float]]) -> str:
    drive = reference.drive
    files = [reference.file, *files_of(drive.manoeuvre.start)]
    return run_key(fmu.path, digest(drive.manoeuvre), drive.step, bounds, files=files)


def in_order(results: Iterable[tuple[int, T]]) -> Iterator[T]:
    """Results sorted by their numbers. `results`: pairs of number and result, in any order."""
    waiting, next_number = dict[int, T](), 0
    for number, result in results:
        waiting[number] = result
        while next_number in waiting:
            yield waiting.pop(next_number)
            next_number += 1


def _read_reference(fmu: Fmu, file: Path, options: ReferenceOptions) -> _Reference:
    manoeuvre, times, columns, missing_columns = _read_table(fmu, file, options.manoeuvre)
    manoeuvre = with_names_of(manoeuvre, fmu.variables)
    check_columns(fmu, manoeuvre)
    driver = driver_of(fmu, manoeuvre)
    manoeuvre, settings = apply_settings(fmu, manoeuvre, options.fmu_options, options.fidelity)
    manoeuvre = replace(manoeuvre, stop_time=float(times[-1]))
    step = _communication_step(fmu, manoeuvre, times) if options.step is None else options.step
    _check_times(times, step, file)
    return _Reference(file, Drive(manoeuvre, step, driver), times, columns, missing_columns, settings)


def _compare(
    fmu: Fmu, reference: _Reference, result: Result, bounds: Sequence[tuple[str, float]], by_table: bool
) -> _Comparison:
    """The comparison of a run with its reference. `by_table`: whether the inputs are columns of the table."""
    file, times, columns = reference.file, reference.times, reference.columns
    manoeuvre, step = reference.drive.manoeuvre, reference.drive.step
    if not any(pattern.startswith(_DIAGNOSTICS) for pattern, _ in bounds):  # they describe the solver, not the car
        columns = {n: values for n, values in columns.items() if not n.startswith(_DIAGNOSTICS)} or columns
    nominals = {n: abs(float(fmu.variables[n].nominal or 1.0)) for n in columns}
    deviation_list = deviations(nominals, result, times, columns, bounds)
    lines = [f"{name}  {words}" for name, words in reference.settings.rows()]
    lines += _table_lines(deviation_list[:_MAX_PRINTED])
    bad = [d for d in deviation_list if not d.good]
    lines += remedies(result, times, columns, bad)
    if constant_inputs := [
        n for n in fmu.names("input") if n not in {*manoeuvre.inputs, *manoeuvre.start} and by_table
    ]:
        lines.append(f"inputs without a column, which keep their start values: {some_of(constant_inputs)}")
    interval = float(np.diff(times).max(initial=0.0))
    if bad and by_table and manoeuvre.inputs and interval > (1.0 + _ROUND_OFF) * step:
        lines.append(f"between rows, up to {interval:g} s apart, inputs go straight: did those of the reference do so?")
    if reference.missing_columns:
        lines.append(f"not compared, for {fmu.path.name} has no such output: {', '.join(reference.missing_columns)}")
    if times[0] > 0.0 and by_table:
        lines.append(f"{file} begins at {times[0]:g} s and is compared from there")
    if result.late:
        lines.append(f"inputs that were held, and late by {500.0 * step:.3g} ms on average: {', '.join(result.late)}")
    lines += [": ".join(missed) for missed in result.missed]
    lines += [f"FMU: {message}" for message in dict.fromkeys(result.messages)]
    if not_finite := result.not_finite():
        lines.append(not_finite)
    default_bound = (
        "" if bounds else f"; the bound is {100.0 * BOUND:g} % of the range of each, --bound NAME=SHARE sets others"
    )
    lines.append(
        f"\n{fmu.path} against {file}, {len(deviation_list)} signals up to {result.time[-1]:g} s in steps of "
        f"{step:g} s: "
        f"{'all within their bounds' if not bad else f'{len(bad)} beyond their bounds'}{default_bound}"
    )
    end_text = f"up to {result.time[-1]:g} s in steps of {step:g} s"
    if result.refusal:
        end_text = f"The reference goes on to {times[-1]:g} s, but {result.refusal}."
        lines.append(end_text)
    elif not_finite:
        end_text = not_finite
    run = Case(file.stem, "run", "good" if result.is_good else "bad", end_text, result.wall)
    missing = [
        Case(file.stem, name, "skipped", f"{fmu.path.name} has no such output") for name in reference.missing_columns
    ]
    return _Comparison(lines, [run, *(deviation.case(file.stem) for deviation in deviation_list), *missing])


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
    return interval / max(1, math.ceil(interval / step - _ROUND_OFF))


def _check_times(times: NDArray[np.float64], step: float, file: Path) -> None:
    if not step > 0.0:
        raise HostError(f"The step is {step:g} s; it must be positive.")
    off = np.abs(times / step - np.round(times / step))
    worst = int(np.argmax(off))
    if off[worst] > _ROUND_OFF:
        raise HostError(
            f"{file} has a row at {times[worst]:.9g} s, which is not a communication point of a run from 0 "
            f"s in steps of {step:g} s; give a step that divides all times (--step)."
        )


def _table_lines(deviation_list: Sequence[Deviation]) -> list[str]:
    rows = [("", "signal", "largest error", "at", "its range", "share of it", "bound")]
    for deviation in deviation_list:
        rows.append((" ok " if deviation.good else "BAD ", deviation.name, *deviation.texts))
    return in_columns(rows)
