"""Tables of a car: CSV files with a line of titles."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ali3.message_text import brief
from ali3.tables import TextTable, number_of
from mbs.vehicle.car_files import car_file_path
from mbs.vehicle.errors import CarFileError


@dataclass(frozen=True)
class Row:
    """A line of a table."""

    where: str
    """Key path, file and line, for messages."""
    cells: dict[str, str]
    """By the titles."""
    decimal: str
    """See `ali3.tables.TextTable`."""

    def __getitem__(self, column: str) -> str:
        return self.cells[column]

    def number(self, column: str, low: float, high: float, unit: str) -> float:
        """A cell as a number. `low`, `high`: least and largest value.

        Raises `CarFileError` if it is not a number or not in the range.
        """
        try:
            value = number_of(self[column], self.decimal)
        except ValueError:
            value = math.nan
        if not low <= value <= high:
            must = f"it must be a number between {low:g} and {high:g} {unit}"
            raise CarFileError(f"{self.where}: {column} is {brief(self[column])}; {must}.")
        return value

    def count(self, column: str, maximum: int) -> int:
        """A cell as a positive integer. `maximum`: largest plausible value."""
        text = self[column]
        if not (text.isascii() and text.isdigit() and 1 <= int(text[:9]) <= maximum):
            must = f"it must be a whole number between 1 and {maximum}"
            raise CarFileError(f"{self.where}: {column} is {brief(text)}; {must}.")
        return int(text)


def read_table(folder: Path, name: str, key: str, columns: Sequence[str]) -> list[Row]:
    """Lines of a table.

    `key`: key path of the name in the car's file, for messages; `columns`: titles that it must have; others may be
    there too. Raises `CarFileError` if there is no such file, it is not text, or a column or a cell is missing.
    """
    what = f"{key} ({name})"
    table = TextTable(car_file_path(folder, name, key), CarFileError, what, known=columns)
    missing = [column for column in columns if column not in table.names]
    if missing:
        raise CarFileError(f"{what} has no column {missing[0]}; its titles are {', '.join(table.names)}.")
    rows = [
        Row(f"{what}, line {row.line}", dict(zip(table.names, row.cells, strict=True)), table.decimal)
        for row in table.rows()
    ]
    if not rows:
        raise CarFileError(f"{what} has no lines under its titles.")
    return rows
