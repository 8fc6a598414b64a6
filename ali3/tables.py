"""Reads tables of text (CSV) of other programs: lines, cells, headings and numbers."""

import csv
import math
import os
import re
from array import array
from collections.abc import Collection, Iterator
from io import TextIOWrapper
from itertools import chain
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ali3.errors import FileError, reason
from ali3.message_text import brief
from ali3.reading import MAX_LINE, Error, open_file, other_encoding

LARGEST = 4_000_000_000
"""Largest size of a table, which is read as a stream, bytes."""
HEADING = re.compile(r"(?P<name>.*) \[(?P<unit>[^\[\]]*)\]")
"""A name with its unit, such as ``speed [m/s]``."""
_WORD = re.compile(r"[^\W\d]\w*")
_SEPARATORS = (";", "\t", ",")
_MAX_CELL = 1000


class Row(NamedTuple):
    """A line of a table."""

    line: int
    """Number of the line in the file, from 1."""
    cells: list[str]
    """Without the blanks around them."""


class TextTable:
    """A table of text, read once from its beginning.

    Empty lines and lines that begin with ``#`` are skipped. The separator is the first of semicolon, tab and comma that
    the first line has; unless it is a comma, numbers may have decimal commas. A cell in quotation marks may contain the
    separator, but no end of a line. All lines have as many cells as the first. The heading may be a comment, as NumPy
    and the databases of race tracks write it.

    Parameters
    ----------
    file : path
        A regular file in UTF-8.
    error : type of exception
        Raised with one sentence that names file and line.
    name : str
        Name of the file in sentences; by default its path.
    headed : bool, optional
        Whether the table must have a heading: its first line, or a comment above it if the first line has numbers;
        None: it may have one. Columns without names are identified by their order.
    known : collection of str
        Names of columns in small letters, without units. A comment is a heading if it has one of them, or if it stands
        right above the values and each of its cells is one word. Without `known`, any comment is one that has as many
        cells as the first line and no number among them.
    units : bool
        Whether names may have units, as `HEADING`.
    whole : bool
        Whether a last line without a line end is skipped: the program that wrote it was killed.
    largest : int
        Limit of the file's size, bytes.

    Attributes
    ----------
    names : list of str
        Names of the columns; empty without a heading.
    units : dict of str to str
        Units by name, if the heading has them.
    comments : list of (int, str)
        Number and text of the lines that begin with ``#``, as far as the table has been read.
    decimal : str
        A decimal mark besides the point: "," or nothing.
    """

    def __init__(
        self,
        file: str | os.PathLike[str],
        error: Error = FileError,
        name: str = "",
        headed: bool | None = True,
        known: Collection[str] = (),
        units: bool = False,
        whole: bool = False,
        largest: int = LARGEST,
    ) -> None:
        self.name, self.error = name or str(file), error
        self.comments: list[tuple[int, str]] = []
        self.names: list[str] = []
        self.units: dict[str, str] = {}
        self._lines = self._read(file, largest, whole)
        self._first_line = next(self._lines, None)
        if self._first_line is None:
            raise error(f"{self.name} contains no values; it needs a heading and at least one row.")
        bare = re.sub(r'"[^"]*"', "", self._first_line[1])  # a name in quotation marks may contain any separator
        separator = next((separator for separator in _SEPARATORS if separator in bare), None)
        self._separator = separator if separator is not None or headed is not False else " "
        self.decimal = "," if self._separator in (";", "\t") else ""
        cells = self._cells(*self._first_line)
        self.width = len(cells)
        heading = self._heading(cells, headed, known)
        if heading:
            self._first_line = None if heading is cells else self._first_line
            self._set_names(heading, units)

    def rows(self, every: int = 1) -> Iterator[Row]:
        """Lines below the heading: the first and each `every`-th after it."""
        lines = self._lines if self._first_line is None else chain([self._first_line], self._lines)
        for k, (line, text) in enumerate(lines):
            if k % every == 0:
                cells = self._cells(line, text)
                if len(cells) != self.width:
                    line_name = "heading" if self.names else "first line"
                    hint = (
                        "; decimal marks must be points." if self._separator == "," and len(cells) > self.width else "."
                    )
                    fault_text = f"{len(cells)} values where the {line_name} has {self.width} columns"
                    raise self.error(f"{self.name}, line {line}: {fault_text}{hint}")
                yield Row(line, cells)

    def numbers(self, row: Row, finite: bool = True, first: int = 0) -> list[float]:
        """Cells of a line as numbers.

        `finite`: whether ``nan`` and ``inf`` are refused; `first`: first column of numbers.
        """
        cells = row.cells[first:]
        if self.decimal:
            cells = [cell.replace(",", ".") for cell in cells]
        text = "".join(cells)
        try:
            results = list(map(float, cells))
        except ValueError:
            results = []
        # `float` also accepts 1_0 and digits of other scripts.
        if results and text.isascii() and "_" not in text and (not finite or all(map(math.isfinite, results))):
            return results
        k = next(k for k, cell in enumerate(row.cells) if k >= first and not is_number(cell, self.decimal, finite))
        label = f", column {brief(self.names[k])}" if self.names else ""
        expected_text = "finite number" if is_number(row.cells[k], self.decimal, finite=False) else "number"
        raise self.error(f"{self.name}, line {row.line}{label}: {brief(row.cells[k])} is not a {expected_text}.")

    def values(self, every: int = 1, finite: bool = True, least: int = 1) -> NDArray[np.float64]:
        """Numbers of the lines, shape (n, columns). `every`, `finite`: see `rows`, `numbers`; `least`: least n."""
        numbers = array("d")
        for row in self.rows(every):
            numbers.extend(self.numbers(row, finite))
        if len(numbers) < least * self.width:
            raise self.error(f"{self.name} contains no values; it needs a heading and at least one row.")
        return np.array(numbers).reshape(-1, self.width)

    def _read(self, file: str | os.PathLike[str], largest: int, whole: bool) -> Iterator[tuple[int, str]]:
        line = 0
        try:
            with TextIOWrapper(open_file(file, largest, self.error, self.name), encoding="utf-8-sig") as stream:
                if message := other_encoding(stream.buffer.read(200)):
                    raise self.error(f"{self.name} is {message}.")
                stream.seek(0)
                while text := stream.readline(MAX_LINE + 1):
                    line += 1
                    if len(text) > MAX_LINE:
                        raise self.error(f"{self.name}, line {line} has more than {MAX_LINE} characters.")
                    if "\0" in text:
                        raise self.error(f"{self.name} is not text: there is a zero byte in line {line}.")
                    bare = text.strip()
                    if bare.startswith("#"):
                        self.comments.append((line, bare))
                    elif bare and (text.endswith("\n") or not whole):
                        yield line, text.rstrip("\r\n")
        except UnicodeDecodeError:
            raise self.error(f"{self.name} is not text in UTF-8; its fault is at about line {line + 1}.") from None
        except OSError as fault:
            if isinstance(fault, self.error):
                raise
            raise self.error(f"{self.name} cannot be read: {reason(fault)}.") from None

    def _cells(self, line: int, text: str) -> list[str]:
        if self._separator == " ":
            return text.split()
        try:
            return cells_of(text, self._separator or ",")
        except ValueError as fault:
            raise self.error(f"{self.name}, line {line}: {fault}.") from None

    def _heading(self, first: list[str], headed: bool | None, known: Collection[str]) -> list[str]:
        """Cells of the heading, which is the first line or a comment above it; empty: there is none."""
        if headed is False:
            return []
        if not any(is_number(cell, self.decimal) for cell in first):
            return first
        for line, cells in self.comment_cells():
            if any(map(is_number, cells)):
                continue
            if not known or any(plain_name(cell) in known for cell in cells) or self._is_heading(line, cells):
                return cells
        if not is_number(first[0], self.decimal):
            return first
        if headed:
            raise self.error(
                f"{self.name}, line {self._first_line[0] if self._first_line else 1}: {brief(first[0])} is a number; "
                "above the first values there must be a heading with a name for each column."
            )
        return []

    def _is_heading(self, line: int, cells: list[str]) -> bool:
        """Whether a comment is right above the first values, has their separator, and each of its cells is one word."""
        if (
            self._first_line is None
            or line != self._first_line[0] - 1
            or (self._separator or ",") not in dict(self.comments)[line]
        ):
            return False
        return all(_WORD.fullmatch(plain_name(cell)) for cell in cells)

    def comment_cells(self) -> list[tuple[int, list[str]]]:
        """Number and cells of each comment, read so far, that has as many cells as the first line."""
        results = []
        for line, comment in self.comments:
            text = comment.lstrip("# \t")
            for separator in (self._separator or ",", *_SEPARATORS, " "):
                try:
                    cells = text.split() if separator == " " else cells_of(text, separator)
                except ValueError:  # not a line of a table
                    continue
                if len(cells) == self.width:
                    results.append((line, cells))
                    break
        return results

    def _set_names(self, cells: list[str], units: bool) -> None:
        known_names = set[str]()  # a table may have a million columns
        for cell in cells:
            match = HEADING.fullmatch(cell) if units else None
            name = match["name"] if match else cell
            if name in known_names:
                raise self.error(f"{self.name} has the column {brief(name)} twice.")
            known_names.add(name)
            self.names.append(name)
            if match:
                self.units[name] = match["unit"]


def cells_of(line: str, separator: str) -> list[str]:
    """Cells of a line, stripped of blanks. Raises `ValueError`, whose message is a predicate of the line."""
    if '"' in line:
        try:
            cells = next(csv.reader([line], delimiter=separator, skipinitialspace=True, strict=True), [])
        except csv.Error as fault:
            raise ValueError(f"this is not a line of a CSV file: {fault}") from None
    else:
        cells = line.split(separator)
    if len(line) > _MAX_CELL and (longest := max(map(len, cells))) > _MAX_CELL:
        raise ValueError(f"a cell has {longest} characters; a number or a name has at most {_MAX_CELL}")
    return [cell.strip() for cell in cells]


def plain_name(cell: str) -> str:
    """A name of a heading in small letters, without its unit."""
    return re.sub(r"\s*[\[(][^\[\]()]*[\])]$", "", cell.strip()).lower()


def number_of(cell: str, decimal: str = "") -> float:
    """A cell as a number; `decimal`: "," if decimal commas are allowed. Raises `ValueError` if it is not a number."""
    if not cell.isascii() or "_" in cell:  # `float` would accept these
        raise ValueError
    return float(cell.replace(",", ".") if decimal else cell)


def is_number(cell: str, decimal: str = "", finite: bool = True) -> bool:
    """Whether a cell is a decimal number; see `number_of`."""
    try:
        return math.isfinite(number_of(cell, decimal)) or not finite
    except ValueError:
        return False
