"""The comparison of a run with a table of reference results: lines for the terminal, and cases for reports."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ali3.columns import in_columns, some_of
from hosts.check.deviations import BOUND, Deviation, deviations, remedies
from hosts.check.reference_table import ROUND_OFF, Reference
from hosts.check.verdict_files import Case
from hosts.driving.result import Result
from hosts.fmu.fmu import Fmu

_MAX_PRINTED = 10
_DIAGNOSTICS = "solver."


@dataclass(frozen=True)
class Comparison:
    """The comparison of a run with a table."""

    lines: list[str]
    """Lines for the terminal."""
    cases: list[Case]
    """The run, and each signal."""


def compare(
    fmu: Fmu, reference: Reference, result: Result, bounds: Sequence[tuple[str, float]], by_table: bool
) -> Comparison:
    """The comparison of a run with its reference. `by_table`: whether the inputs are columns of the table."""
    file, times, columns = reference.file, reference.times, reference.columns
    if not any(pattern.startswith(_DIAGNOSTICS) for pattern, _ in bounds):  # they describe the solver, not the car
        columns = {n: values for n, values in columns.items() if not n.startswith(_DIAGNOSTICS)} or columns
    nominals = {n: abs(float(fmu.variables[n].nominal or 1.0)) for n in columns}
    compared = deviations(nominals, result, times, columns, bounds)
    bad = [d for d in compared if not d.good]
    span = f"up to {result.time[-1]:g} s in steps of {reference.drive.step:g} s"
    judgement = "all within their bounds" if not bad else f"{len(bad)} beyond their bounds"
    default_bound = f"; the bound is {100.0 * BOUND:g} % of the range of each, --bound NAME=SHARE sets others"
    lines = [
        *(f"{name}  {words}" for name, words in reference.settings.rows()),
        *_table_lines(compared[:_MAX_PRINTED]),
        *remedies(result, times, columns, bad),
        *(_notes_on_table(fmu, reference, bool(bad)) if by_table else ()),
        *_notes_on_run(fmu, reference, result),
        f"\n{fmu.path} against {file}, {len(compared)} signals {span}: {judgement}{'' if bounds else default_bound}",
    ]
    end_text = result.not_finite() or span
    if result.refusal:
        end_text = f"The reference goes on to {times[-1]:g} s, but {result.refusal}."
        lines.append(end_text)
    cases = [Case(file.stem, "run", "good" if result.is_good else "bad", end_text, result.wall)]
    cases += [deviation.case(file.stem) for deviation in compared]
    no_output = f"{fmu.path.name} has no such output"
    cases += [Case(file.stem, name, "skipped", no_output) for name in reference.missing_columns]
    return Comparison(lines, cases)


def _notes_on_table(fmu: Fmu, reference: Reference, is_bad: bool) -> Iterator[str]:
    """Notes on inputs that are columns of the table: missing ones, those between far rows, a late begin."""
    times, manoeuvre = reference.times, reference.drive.manoeuvre
    if constant := [n for n in fmu.names("input") if n not in {*manoeuvre.inputs, *manoeuvre.start}]:
        yield f"inputs without a column, which keep their start values: {some_of(constant)}"
    interval = float(np.diff(times).max(initial=0.0))
    if is_bad and manoeuvre.inputs and interval > (1.0 + ROUND_OFF) * reference.drive.step:
        yield f"between rows, up to {interval:g} s apart, inputs go straight: did those of the reference do so?"
    if times[0] > 0.0:
        yield f"{reference.file} begins at {times[0]:g} s and is compared from there"


def _notes_on_run(fmu: Fmu, reference: Reference, result: Result) -> Iterator[str]:
    """Notes on what was not compared, and on deviations of the run from its request."""
    if reference.missing_columns:
        yield f"not compared, for {fmu.path.name} has no such output: {', '.join(reference.missing_columns)}"
    if result.late:
        delay = 500.0 * reference.drive.step
        yield f"inputs that were held, and late by {delay:.3g} ms on average: {', '.join(result.late)}"
    yield from (": ".join(missed) for missed in result.missed)
    yield from (f"FMU: {message}" for message in dict.fromkeys(result.messages))
    if not_finite := result.not_finite():
        yield not_finite


def _table_lines(deviation_list: Sequence[Deviation]) -> list[str]:
    rows = [("", "signal", "largest error", "at", "its range", "share of it", "bound")]
    for deviation in deviation_list:
        rows.append((" ok " if deviation.good else "BAD ", deviation.name, *deviation.texts))
    return in_columns(rows)
