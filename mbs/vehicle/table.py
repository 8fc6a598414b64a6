"""Tables beside a car file: CSV with a line of titles; lines that begin with # are comments."""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from mbs.vehicle.errors import CarFileError
from mbs.vehicle.files import LARGEST_TABLE, beside, text_of


@dataclass(frozen=True)
class Row:
    """A line of a table.

    Attributes
    ----------
    where : str
        Key path, file and line, for messages.
    cells : dict of str to str
        By the titles.
    """

    where: str
    cells: dict[str, str]

    def __getitem__(self, column: str) -> str:
        return self.cells[column]

    def number(self, column: str, low: float, high: float, unit: str) -> float:
        """A cell as a number.

        Parameters
        ----------
        column : str
            Its title.
        low, high : float
            Least and largest plausible value.
        unit : str
            For the message.

        Raises
        ------
        CarFileError
            It is no number or not in the range.
        """
        try:
            value = math.nan if "_" in self[column] else float(self[column])
        except ValueError:
            value = math.nan
        if not low <= value <= high:
            raise CarFileError(
                f"{self.where}: {column} is {self[column]!r}; it must be a number between {low:g} and {high:g} {unit}."
            )
        return value

    def count(self, column: str, most: int) -> int:
        """A cell as a whole number from 1 on.

        Parameters
        ----------
        column : str
            Its title.
        most : int
            Largest plausible value.

        Raises
        ------
        CarFileError
            It is none.
        """
        text = self[column]
        if not (text.isascii() and text.isdigit() and 1 <= int(text[:9]) <= most):
            raise CarFileError(f"{self.where}: {column} is {text!r}; it must be a whole number between 1 and {most}.")
        return int(text)


def read_table(folder: Path, name: str, key: str, columns: Sequence[str]) -> list[Row]:
    """Lines of a table.

    Parameters
    ----------
    folder : Path
        Of the car's file.
    name : str
        Of the table.
    key : str
        Key path of the name in the car's file, for messages.
    columns : sequence of str
        Titles that it must have; others may be there too.

    Raises
    ------
    CarFileError
        There is no such file, it is no text, or a column or a cell is missing.
    """
    path = beside(folder, name, key)
    what = f"{key} ({name})"
    text = text_of(path, LARGEST_TABLE)
    lines = [(n, line) for n, line in enumerate(text.splitlines(), 1) if line.strip() and not line.startswith("#")]
    try:
        table = list(csv.reader([line for _, line in lines], strict=True))
    except csv.Error as error:
        raise CarFileError(f"{what} is no table in CSV: {error}.") from error
    if len(table) != len(lines):
        raise CarFileError(f"{what} is no table in CSV: a cell goes over several lines.")
    titles: list[str] | None = None
    rows = []
    for (number, _), cells in zip(lines, table, strict=True):
        stripped = [cell.strip() for cell in cells]
        if titles is None:
            titles = stripped
            missing = [c for c in columns if c not in titles]
            if missing:
                raise CarFileError(f"{what} has no column {missing[0]}; its titles are {', '.join(titles)}.")
            if len(set(titles)) != len(titles):
                raise CarFileError(f"{what} has two columns of one title: {', '.join(titles)}.")
        elif len(stripped) != len(titles):
            raise CarFileError(f"{what}, line {number}: {len(stripped)} cells; there are {len(titles)} titles.")
        else:
            rows.append(Row(f"{what}, line {number}", dict(zip(titles, stripped, strict=True))))
    if not rows:
        raise CarFileError(f"{what} has no lines under its titles.")
    return rows
