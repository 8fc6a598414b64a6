"""Manoeuvres as plain CSV files."""

import re
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TypeVar

import numpy as np

from ali3.decimal_number import parse_number
from ali3.message_text import brief
from ali3.near_names import near_names
from ali3.tables import HEADING, TextTable
from hosts.common.errors import HostError
from hosts.common.numbers import Value, parse_value
from hosts.driving.manoeuvre import ON_TIME, Manoeuvre
from hosts.driving.run_record import RunRecord, read_state, record_of, rows_before_jumps

_LATEST = ON_TIME * 2.0**52  # s; later times are farther apart than `ON_TIME` as double numbers
# The remark of a page on a table without its oldest rows.
_CUT_REMARK = re.compile("the first .* s are not in this table")
_KEYS = ("start", "state", "step", "outputs from", "held")
_SIMILARITY = 0.75  # from which a remark counts as a misspelt key

_Parsed = TypeVar("_Parsed", float, Value)


def read_table(path: Path, input_names: Collection[str] | None = None) -> Manoeuvre:
    """Read a CSV file of inputs over time in FMPy's format: ``"time"``, then names of inputs.

    Lines that begin with ``#`` may say more: ``# start: NAME=VALUE, ...`` gives start values, ``# state: FILE at TIME``
    names a saved state of the FMU, beside the table, to begin with. Behind a table that a page has recorded stands a
    line ``# outputs from: NAME``: that column and those after it are what came out, and are not read; its inputs were
    held. A line ``# held: NAME, NAME`` names inputs that keep the value of a row up to the next one; the others go
    straight, and a time that stands twice is a jump. ``# step: H`` is the communication step that it was recorded
    with. A table that a run has written is read with the record beside it.

    `input_names`: columns of other names are not read. By default all columns are inputs. Raises `HostError` with the
    line and the reason.
    """
    table = TextTable(path, HostError, known=("time",))
    names = table.names
    for match in filter(None, map(HEADING.fullmatch, names)):
        if input_names is None or match[0] not in input_names:
            raise HostError(
                f"{path}: the heading {brief(match[0])} has a unit; here it is {brief(match['name'])} alone, and its "
                "values are in the unit that the FMU has for it, times in s."
            )
    if names[0] != "time" or len(names) < 2:
        raise HostError(f'{path}: the heading is {brief(", ".join(names))}; it must be "time" and the names of inputs.')
    rows = _rows_of(table, path)
    record = _with_remarks(record_of(path), table.comments, path)
    first_output = record.outputs_from
    if first_output and first_output not in names[1:]:
        raise HostError(f"{path}: there is no column {brief(first_output)}, with which outputs would begin.")
    inputs = names[1 : names.index(first_output)] if first_output else names[1:]
    if lost := [n for n in inputs if n in record.lost and (input_names is None or n in input_names)]:
        raise HostError(
            f"{path} was written every {record.interval:g} s, and {', '.join(lost)} moved in between otherwise than "
            "its rows tell, so that the run cannot be repeated; run without --interval to have a table that repeats."
        )
    for k, before in rows_before_jumps(record, path, [row[0] for row in rows], len(inputs)):
        rows.insert(k, [rows[k][0], *before, *rows[k][len(before) + 1 :]])
    values = np.array(rows)
    columns = {
        name: values[:, k] for k, name in enumerate(inputs, start=1) if input_names is None or name in input_names
    }
    held_inputs = frozenset(inputs if record.held is None and first_output else record.held or ())
    if not held_inputs <= set(inputs):
        raise HostError(
            f"{path}: {brief(min(held_inputs - set(inputs)))} is listed as held but is not an input of the table."
        )
    return Manoeuvre(
        path.stem,
        values[:, 0],
        columns,
        stop_time=float(values[-1, 0]),
        start={name: value for name, value in record.start.items() if name not in columns},
        state=record.state[0],
        state_time=record.state[1],
        held=held_inputs & set(columns),
        step=record.step,
    )


def _rows_of(table: TextTable, path: Path) -> list[list[float]]:
    """Rows of a table whose times, in the first column, do not decrease."""
    rows: list[list[float]] = []
    for row in table.rows():
        rows.append(table.numbers(row))
        if len(rows) > 1 and rows[-1][0] < rows[-2][0]:
            raise HostError(f"{path}, line {row.line}: time goes back from {rows[-2][0]:g} s to {rows[-1][0]:g} s.")
    if not rows:
        raise HostError(f"{path} contains no values; it needs a heading and at least one row.")
    check_times([row[0] for row in rows], path)
    return rows


def _with_remarks(record: RunRecord, comments: Iterable[tuple[int, str]], path: Path) -> RunRecord:
    """A record with the values of remarks of the table in place of its own. `comments`: see `TextTable`."""
    start: dict[str, Value] = {}
    for line, comment in comments:
        key, _, content = comment.lstrip("# ").partition(":")
        key, where = key.strip(), f"{path}, line {line}"
        if key == "start":
            _add_start_values(start, content.split(","), where)
        elif key == "state":
            name, at, instant = content.rpartition(" at ")
            if not at:
                raise HostError(f"{where}: {brief(content.strip())} is not of the form FILE at TIME.")
            state = read_state(path.parent, name.strip(), where)
            record = replace(record, state=(state, _parsed(parse_number, instant, f"{where}, time of the state")))
        elif key == "step":
            step = _parsed(parse_number, content, f"{where}, communication step")
            if not step > 0.0:
                raise HostError(f"{where}: the communication step is {step:g} s; it must be positive.")
            record = replace(record, step=step)
        elif key == "outputs from":
            record = replace(record, outputs_from=content.strip())
        elif key == "held":
            record = replace(record, held={name.strip() for name in content.split(",")})
        elif _CUT_REMARK.fullmatch(key):
            raise HostError(f"{where}: {key}, so that the run cannot be repeated; record a shorter one.")
        elif content and (near := near_names(key, _KEYS, 1, _SIMILARITY)):
            raise HostError(
                f"{where}: {brief(key + ':')} is not a key of a table; did you mean '{near[0]}:'? In a remark leave "
                "the colon out."
            )
    return replace(record, start={**record.start, **start})


def check_begin(first: float, last: float, path: Path) -> None:
    """Refuse a table with times, s, before 0 or too large for distinct rows, as those since 1970."""
    if first < 0.0:
        raise HostError(f"{path} begins at {first:.15g} s; a run begins at 0: add {-first:.15g} s to all its times.")
    if last > _LATEST:
        raise HostError(
            f"{path} goes from {first:.15g} to {last:.15g} s; a run begins at 0 and ends before {_LATEST:.2g} s: "
            "subtract the first time from all, and write them in s."
        )


def check_times(times: Sequence[float], path: Path) -> None:
    """Refuse times, s, of rows of inputs that `check_begin` refuses, and a time of more than two rows."""
    check_begin(times[0], times[-1], path)
    if (thrice := next((a for a, b in zip(times, times[2:], strict=False) if a == b), None)) is not None:
        raise HostError(
            f"{path} has more than two rows at {thrice:.15g} s; a jump has two, with the values before and after it."
        )


def _add_start_values(start_values: dict[str, Value], assignments: Iterable[str], where: str) -> None:
    for assignment in assignments:
        name, equals, value = assignment.partition("=")
        if not equals:
            raise HostError(f"{where}: {brief(assignment.strip())} is not of the form name=value.")
        if name.strip() in start_values:
            raise HostError(f"{where}: the start value {brief(name.strip())} is given twice.")
        start_values[name.strip()] = _parsed(parse_value, value, f"{where}, start value {brief(name.strip())}")


def _parsed(parse: Callable[[str], _Parsed], text: str, where: str) -> _Parsed:
    """A number or a value from its text. Raises `HostError`; `where`: the place in the file, for messages."""
    try:
        return parse(text)
    except ValueError as error:
        raise HostError(f"{where}: {error}.") from None
