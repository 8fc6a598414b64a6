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
_MAX_LINES = 60  # that are read: loggers write their settings first
_MAX_BYTES = 400_000  # that are read for these lines
_NUMBER = re.compile(r"[+-]?(\d+([.,]\d*)?|[.,]\d+)([eE][+-]?\d+)?")
_MISSING = ("", "nan", "na", "n/a", "null", "-", "#n/a", "--", "inf", "-inf")
_DATE = re.compile(r"(\d{4}-\d\d-\d\d[T ]|\d\d?([./])\d\d?\2\d{4} ).*")  # other orders are refused later
CLOCK_TIME = re.compile(r"[+-]?\d+:\d\d(:\d\d)?([.,]\d*)?")
"""Hours, minutes and seconds, or minutes and seconds."""
_WITH_UNIT = re.compile(rf"({_NUMBER.pattern})\s*(?P<unit>[A-Za-z°%µ][\w°%µ/²^.]*)")
_NAME_AND_UNIT = re.compile(r"(?P<name>.*?)\s*[\[(](?P<unit>[^\[\]()]*)[\])]")


@dataclass(frozen=True)
class DetectedDialect:
    """The dialect of a file, and its columns."""

    delimiter: str
    decimal: str
    encoding: str
    names: list[str]
    """Names of the columns without units; empty if a column has none."""
    units: dict[str, str]
    """Units as written, by name."""
    first_row: int
    """Number of lines before the first row of values."""


def detect_dialect(path: Path, stated: Dialect) -> DetectedDialect:
    """Detect the dialect of a file from its first lines, as far as it is not stated.

    Raises `HostError` if the file holds no table, or does not have the stated dialect.
    """
    lines, encoding = _first_lines(path, stated.encoding)
    if not any(line.strip() for line in lines):
        raise HostError(f"The log {path} is empty; it needs a line of names and rows of values.")
    candidates = [(d, *_first_row(lines, d)) for d in ((stated.delimiter,) if stated.delimiter else _DELIMITERS)]
    # A comma may also be a decimal sign: the delimiter with the most values, then the most columns, is right.
    delimiter, first, width, _ = max(candidates, key=lambda item: (item[3], item[2]))
    if width < 2:
        _refuse_units_in_cells(path, lines, stated)
        if not any(map(re.compile(r'\s*"?[+-]?[.,]?\d').match, lines)):
            raise HostError(f"The log {path} has no line that begins with a number; below its names it needs rows.")
        tried = "' or '".join(repr(d)[1:-1] for d, *_ in candidates)
        raise HostError(
            f"The log {path} is not a table of numbers with a time and signals, divided by '{tried}'; its first line "
            f'is {lines[0].strip()[:60]!r}. [file] delimiter = "..." of the alias file names another.'
        )
    heading, unit_line = _heading_lines(path, lines, delimiter, first, width, stated)
    names, units = [], {}
    for k, cell in enumerate(_cells(_strip_comment(lines[heading]), delimiter)):
        match = _NAME_AND_UNIT.fullmatch(cell)
        name = match["name"] if match else cell
        names.append(name)
        if match:
            units[name] = match["unit"]
        elif unit_line is not None:
            cells = _cells(_strip_comment(lines[unit_line]), delimiter)
            units[name] = cells[k] if k < len(cells) else ""
    duplicate = next((n for k, n in enumerate(names) if n and n in names[:k]), None)
    if duplicate is not None:
        raise HostError(f"The log {path} has the column '{duplicate}' twice.")
    decimal = stated.decimal or _decimal_sign(lines[first:], delimiter)
    return DetectedDialect(delimiter, decimal, encoding, names, units, first)


def unit_message(cell: str) -> str:
    """The message on a cell that holds a number with its unit, without its subject; empty for other cells."""
    match = _WITH_UNIT.fullmatch(cell.strip())
    if match is None or known_unit(match["unit"]) is None:
        return ""
    return (
        f"{brief(cell.strip())} has a unit after the number; write numbers alone, and the unit in the heading, "
        f"such as 'name [{match['unit']}]'."
    )


def _refuse_units_in_cells(path: Path, lines: Sequence[str], stated: Dialect) -> None:
    """Raises `HostError` if a line would be a row of numbers without the units in its cells."""
    for line, delimiter in ((k, d) for k in range(len(lines)) for d in (stated.delimiter, *_DELIMITERS) if d):
        cells = [cell.strip() for cell in lines[line].split(delimiter)]
        messages = [message for cell in cells if (message := unit_message(cell))]
        if len(cells) > 1 and messages and 2 * (len(messages) + sum(map(_is_value, cells))) > len(cells):
            raise HostError(f"The log {path}, line {line + 1}: {messages[0]}")


def _first_lines(path: Path, encoding: str | None) -> tuple[list[str], str]:
    """First lines of a file and their encoding. Raises `HostError` if it is not text in the stated encoding."""
    with io.BufferedReader(Unpacked(path, LARGEST, HostError, f"The log {path}", zeros=True)) as stream:
        content = stream.read(_MAX_BYTES)
    if message := other_encoding(content):
        raise HostError(f"The log {path} is {message}.")
    if b"\0" in content:
        raise HostError(f"The log {path} is not text; logs are read as CSV or Parquet (MDF files can be converted).")
    for name in (encoding,) if encoding else ("utf-8-sig", "latin-1"):
        try:
            text = content[: content.rfind(b"\n") + 1 or None].decode(name)
            return text.splitlines()[:_MAX_LINES], name
        except (LookupError, ValueError):  # an unknown encoding, or not that of the file
            continue
    raise HostError(f"The log {path} is not written in {encoding}; [file] encoding of the alias file is wrong.")


def _cells(line: str, delimiter: str) -> list[str]:
    try:
        return cells_of(line, delimiter)
    except ValueError as fault:
        raise HostError(f"The log has a line that cannot be read: {fault}.") from None


def _is_value(cell: str) -> bool:
    return (
        cell.lower() in _MISSING
        or bool(_NUMBER.fullmatch(cell))
        or bool(_DATE.fullmatch(cell) or CLOCK_TIME.fullmatch(cell))
    )


def _first_row(lines: Sequence[str], delimiter: str) -> tuple[int, int, float]:
    """Index of the first row of values, its number of columns and its fraction of values; 0 columns: there is none."""
    for k, line in enumerate(lines):
        try:
            cells = cells_of(line, delimiter)
            following = [cells_of(other, delimiter) for other in lines[k : k + 3] if other.strip()]
        except ValueError:  # a delimiter inside quotation marks
            continue
        # A column may hold words: most cells of a row are values, and one at least is a number.
        numbers = sum(map(_is_value, cells))
        is_row = len(cells) > 1 and any(_NUMBER.fullmatch(c) for c in cells) and 2 * numbers > len(cells)
        if is_row and all(len(other) == len(cells) for other in following):
            return k, len(cells), numbers / len(cells)
    return 0, 0, 0.0


def _heading_lines(
    path: Path, lines: Sequence[str], delimiter: str, first: int, width: int, stated: Dialect
) -> tuple[int, int | None]:
    """Indices of the lines of names and of units. `first`: index of the first row of values; `width`: its columns."""
    for key, line in (("heading", stated.heading), ("units", stated.units)):
        if line is not None and line > first:
            raise HostError(f"The log {path}: [file] {key} is line {line}; values begin in line {first + 1}.")
    units = stated.units - 1 if stated.units else None
    if stated.heading is not None:
        below = stated.heading
        if stated.units is None and below < first and len(_cells(lines[below], delimiter)) == width:
            units = below
        return stated.heading - 1, units
    fitting = [
        k for k in range(first) if k != units and _is_heading(_cells(_strip_comment(lines[k]), delimiter), width)
    ]
    headings = [k for k in fitting if lines[k] == _strip_comment(lines[k])] or fitting
    # A comment may hold the names, or the units.
    headings += [k for k in fitting if k not in headings and _has_units(_cells(_strip_comment(lines[k]), delimiter))]
    if not headings:
        raise HostError(
            f"The log {path} has no line of {width} names before its values in line {first + 1}; "
            f"[file] heading of the alias file can name it."
        )
    # The line of names comes first, the line of units second.
    return headings[0], headings[1] if stated.units is None and len(headings) > 1 else units


def _is_heading(cells: Sequence[str], width: int) -> bool:
    """Whether a line may hold names; of other lines, which loggers pad with delimiters, most cells are empty."""
    return len(cells) == width and 2 * sum(map(bool, cells)) > width


def _has_units(cells: Sequence[str]) -> bool:
    return all(known_unit(cell) is not None for cell in cells)


def _strip_comment(line: str) -> str:
    """A line without the mark of a comment."""
    return line.lstrip(" #") if line.lstrip().startswith("#") else line


def _decimal_sign(rows: Sequence[str], delimiter: str) -> str:
    """The decimal sign of most numbers in rows of values; a point where commas delimit."""
    if delimiter == ",":
        return "."
    cells = [cell for row in rows for cell in _cells(row, delimiter)]
    commas = sum("," in cell and bool(_NUMBER.fullmatch(cell)) for cell in cells)
    points = sum("." in cell and bool(_NUMBER.fullmatch(cell)) for cell in cells)
    return "," if commas > points else "."
