"""Detects the dialect of a CSV file of a data logger: delimiter, decimal sign, lines of names and units."""

import io
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ali3.message_text import brief
from ali3.reading import other_encoding
from ali3.tables import LARGEST, cells_of
from ali3.units import known_unit
from ali3.unpacked_size import Unpacked
from hosts.common.errors import HostError
from hosts.compare.log_aliases import Dialect

_DELIMITERS = (";", "\t", ",", "|")
_LINES = 60  # that are looked at: loggers write their settings first
_NUMBER = re.compile(r"[+-]?(\d+([.,]\d*)?|[.,]\d+)([eE][+-]?\d+)?")
_NOT_THERE = ("", "nan", "na", "n/a", "null", "-", "#n/a", "--", "inf", "-inf")
_DATE = re.compile(r"(\d{4}-\d\d-\d\d[T ]|\d\d?([./])\d\d?\2\d{4} ).*")  # the latter to be refused by its name
CLOCK_TIME = re.compile(r"[+-]?\d+:\d\d(:\d\d)?([.,]\d*)?")
"""Hours, minutes and seconds, or minutes and seconds."""
_WITH_UNIT = re.compile(rf"({_NUMBER.pattern})\s*(?P<unit>[A-Za-z°%µ][\w°%µ/²^.]*)")
_NAME_AND_UNIT = re.compile(r"(?P<name>.*?)\s*[\[(](?P<unit>[^\[\]()]*)[\])]")


@dataclass(frozen=True)
class FoundDialect:
    """The dialect of a file, and its columns."""

    delimiter: str
    decimal: str
    encoding: str
    names: list[str]
    """Of the columns, without units; those without a name are empty."""
    units: dict[str, str]
    """As they are written, by name."""
    first_row: int
    """Lines before the first row of values."""


def find_dialect(path: Path, stated: Dialect) -> FoundDialect:
    """Look at the first lines of a file for what is not stated.

    Raises `HostError`: it holds no table, or what is stated does not fit it.
    """
    lines, encoding = _first_lines(path, stated.encoding)
    if not any(line.strip() for line in lines):
        raise HostError(f"The log {path} is empty; it needs a line of names and rows of values.")
    results = [(d, *_rows(lines, d)) for d in ((stated.delimiter,) if stated.delimiter else _DELIMITERS)]
    # A comma may also divide numbers and seconds: what leaves the most values, then the most columns, is right.
    delimiter, first, width, _ = max(results, key=lambda item: (item[3], item[2]))
    if width < 2:
        _refuse_units(path, lines, stated)
        tried = "' or '".join(repr(d)[1:-1] for d, *_ in results)
        raise HostError(
            f"The log {path} is not a table of numbers with a time and signals, divided by '{tried}'; its first line "
            f'is {lines[0].strip()[:60]!r}. [file] delimiter = "..." of the alias file names another.'
        )
    heading, unit_line = _heading(path, lines, delimiter, first, width, stated)
    names, units = [], {}
    for k, cell in enumerate(_cells(_bare(lines[heading]), delimiter)):
        match = _NAME_AND_UNIT.fullmatch(cell)
        name = match["name"] if match else cell
        names.append(name)
        if match:
            units[name] = match["unit"]
        elif unit_line is not None:
            cells = _cells(_bare(lines[unit_line]), delimiter)
            units[name] = cells[k] if k < len(cells) else ""
    twice = next((n for k, n in enumerate(names) if n and n in names[:k]), None)
    if twice is not None:
        raise HostError(f"The log {path} has the column '{twice}' twice.")
    decimal = stated.decimal or _decimal(lines[first:], delimiter)
    return FoundDialect(delimiter, decimal, encoding, names, units, first)


def unit_behind(cell: str) -> str:
    """What is wrong with a cell that is a number with its unit, as the rest of a sentence; empty: it is no such."""
    match = _WITH_UNIT.fullmatch(cell.strip())
    if match is None or known_unit(match["unit"]) is None:
        return ""
    return (
        f"{brief(cell.strip())} has its unit behind its number; cells are numbers alone, and the unit stands in the "
        f"heading, such as 'name [{match['unit']}]'."
    )


def _refuse_units(path: Path, lines: Sequence[str], stated: Dialect) -> None:
    """Raises `HostError` where a line would be one of numbers without the units in its cells."""
    for line, delimiter in ((k, d) for k in range(len(lines)) for d in (stated.delimiter, *_DELIMITERS) if d):
        cells = [cell.strip() for cell in lines[line].split(delimiter)]
        results = [message for cell in cells if (message := unit_behind(cell))]
        if len(cells) > 1 and results and 2 * (len(results) + sum(map(_is_value, cells))) > len(cells):
            raise HostError(f"The log {path}, line {line + 1}: {results[0]}")


def _first_lines(path: Path, encoding: str | None) -> tuple[list[str], str]:
    with io.BufferedReader(Unpacked(path, LARGEST, HostError, f"The log {path}", zeros=True)) as stream:
        content = stream.read(400_000)
    if message := other_encoding(content):
        raise HostError(f"The log {path} is {message}.")
    if b"\0" in content:
        raise HostError(f"The log {path} is not text; logs are read as CSV or Parquet (MDF files can be converted).")
    for name in (encoding,) if encoding else ("utf-8-sig", "latin-1"):
        try:
            text = content[: content.rfind(b"\n") + 1 or None].decode(name)
            return text.splitlines()[:_LINES], name
        except (LookupError, ValueError):  # no such encoding, or not that of the content
            continue
    raise HostError(f"The log {path} is not written in {encoding}; [file] encoding of the alias file is wrong.")


def _cells(line: str, delimiter: str) -> list[str]:
    try:
        return cells_of(line, delimiter)
    except ValueError as fault:
        raise HostError(f"The log has a line that cannot be read: {fault}.") from None


def _is_value(cell: str) -> bool:
    return (
        cell.lower() in _NOT_THERE
        or bool(_NUMBER.fullmatch(cell))
        or bool(_DATE.fullmatch(cell) or CLOCK_TIME.fullmatch(cell))
    )


def _rows(lines: Sequence[str], delimiter: str) -> tuple[int, int, float]:
    """Where rows of values begin, how many columns they have, and which part are values; 0 columns: nowhere."""
    for k, line in enumerate(lines):
        try:
            cells = cells_of(line, delimiter)
            following = [cells_of(other, delimiter) for other in lines[k : k + 3] if other.strip()]
        except ValueError:  # a mark inside a name in quotation marks divides nothing
            continue
        # A column may hold words; the most are values, and the first, mostly the time, is one.
        numbers = sum(map(_is_value, cells))
        is_row = len(cells) > 1 and any(_NUMBER.fullmatch(c) for c in cells) and 2 * numbers > len(cells)
        if is_row and all(len(other) == len(cells) for other in following):
            return k, len(cells), numbers / len(cells)
    return 0, 0, 0.0


def _heading(
    path: Path, lines: Sequence[str], delimiter: str, first: int, width: int, stated: Dialect
) -> tuple[int, int | None]:
    """Places of the line of names and of that of units; `first`: that of the first row of values, 0 of the file's."""
    for key, line in (("heading", stated.heading), ("units", stated.units)):
        if line is not None and line > first:
            raise HostError(f"The log {path}: [file] {key} is line {line}; values begin in line {first + 1}.")
    units = stated.units - 1 if stated.units else None
    if stated.heading is not None:
        below = stated.heading
        if stated.units is None and below < first and len(_cells(lines[below], delimiter)) == width:
            units = below
        return stated.heading - 1, units
    fitting = [k for k in range(first) if k != units and _is_heading(_cells(_bare(lines[k]), delimiter), width)]
    before = [k for k in fitting if lines[k] == _bare(lines[k])] or fitting
    # Comments may have the names, and units of names that are none.
    before += [k for k in fitting if k not in before and _has_units(_cells(_bare(lines[k]), delimiter))]
    if not before:
        raise HostError(
            f"The log {path} has no line of {width} names before its values in line {first + 1}; "
            f"[file] heading of the alias file can name it."
        )
    # Of the lines with as many cells the names come first and the units second.
    return before[0], before[1] if stated.units is None and len(before) > 1 else units


def _is_heading(cells: Sequence[str], width: int) -> bool:
    """Whether a line may hold names: loggers fill up lines of other words with delimiters."""
    return len(cells) == width and 2 * sum(map(bool, cells)) > width


def _has_units(cells: Sequence[str]) -> bool:
    return all(known_unit(cell) is not None for cell in cells)


def _bare(line: str) -> str:
    """A line without the mark of a comment."""
    return line.lstrip(" #") if line.lstrip().startswith("#") else line


def _decimal(rows: Sequence[str], delimiter: str) -> str:
    if delimiter == ",":
        return "."
    cells = [cell for row in rows for cell in _cells(row, delimiter)]
    commas = sum("," in cell and bool(_NUMBER.fullmatch(cell)) for cell in cells)
    points = sum("." in cell and bool(_NUMBER.fullmatch(cell)) for cell in cells)
    return "," if commas > points else "."
