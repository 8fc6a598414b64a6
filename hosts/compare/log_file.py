"""Reads the table of a log: CSV as data loggers write it, or Parquet."""

from __future__ import annotations

import io
import re
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from ali3.message_text import brief, one_line
from ali3.reading import check_file
from ali3.tables import LARGEST
from ali3.unpacked_size import Unpacked
from hosts.common.errors import HostError
from hosts.common.numbers import LARGEST_NUMBER
from hosts.common.parquet import opened_parquet
from hosts.compare.csv_dialect import detect_dialect, unit_message
from hosts.compare.log_aliases import Dialect
from hosts.driving.run_record import RunRecord, rows_before_jumps

_MDF = (".mf4", ".mdf", ".dat")
_PARQUET = (".parquet", ".pq")


@dataclass(frozen=True)
class RawLog:
    """The table of a log as it is in the file, before units and names."""

    path: Path
    table: pd.DataFrame
    """Columns by name."""
    units: dict[str, str]
    """Units by name, if the file gives them."""
    first_row: int
    """Number of lines of the file before the first row."""
    added: int = 0
    """Number of rows that were added from the record of the run that wrote the file."""
    notes: tuple[str, ...] = ()
    """What was left out, in a sentence each."""

    def with_jumps(self, record: RunRecord) -> RawLog:
        """With a row before each jump of an input of the record of a run. Raises `HostError` if the run is another."""
        if not record.jumps:
            return self
        names = [str(name) for name in self.table.columns]
        last = names.index(record.outputs_from) if record.outputs_from in names else 0
        blocks, end = [], len(self.table)
        for k, values in rows_before_jumps(record, self.path, self.numbers(names[0]).tolist(), last - 1):
            row = self.table.iloc[[k]].copy()
            row.iloc[0, 1:last] = values
            blocks += [self.table.iloc[k:end], row]
            end = k
        table = pd.concat([self.table.iloc[:end], *reversed(blocks)])  # the index is that of the rows of the file
        return replace(self, table=table, added=len(record.jumps))

    def numbers(self, name: str) -> NDArray[np.float64]:
        """Values of a column, shape (n,), NaN where a cell is empty.

        Raises `HostError`, with the line, if a cell is not a number.
        """
        column = self.table[name]
        numbers = pd.to_numeric(column, errors="coerce")
        is_wrong = numbers.isna() & column.notna()
        if is_wrong.any():
            row = int(np.argmax(is_wrong.to_numpy()))
            cell = str(column.iloc[row])
            raise self.error(
                row, name, unit_message(cell) or f"{brief(cell)} is not a number; a cell without one is empty."
            )
        values = np.array(numbers, dtype=np.float64)
        values[~np.isfinite(values)] = np.nan
        beyond = np.flatnonzero(np.abs(values) > LARGEST_NUMBER)
        if len(beyond):
            row = int(beyond[0])
            message = f"{values[row]:g} is too large; numbers up to {LARGEST_NUMBER:g} are read."
            raise self.error(row, name, message)
        return values

    def error(self, row: int, name: str, message: str) -> HostError:
        """The error of a cell, with its line; of a row that repeats the heading an error that says so."""
        cells = self.table.iloc[row].astype(str).str.strip()
        if all(str(cell).startswith(str(column)) for cell, column in zip(cells, self.table.columns, strict=True)):
            message = "the heading occurs again; split the log there and compare each drive by itself."
            return HostError(f"The log {self.path}, line {self.line(row)}: {message}")
        return HostError(f"The log {self.path}, line {self.line(row)}, column '{name}': {message}")

    def line(self, row: int) -> int:
        """Number of the line of a row in the file, from 1; empty lines are not rows."""
        index = int(self.table.index[row])
        if self.path.suffix.lower() in _PARQUET:
            return index + 1
        with io.BufferedReader(Unpacked(self.path, LARGEST, HostError, f"The log {self.path}")) as stream:
            lines = (k for k, text in enumerate(stream, 1) if k > self.first_row and text.strip())
            return next(islice(lines, index, None), self.first_row + index + 1)


def read_log(path: Path, dialect: Dialect) -> RawLog:
    """Read a log.

    `path`: a Parquet file by its suffix, otherwise CSV; `dialect`: stated dialect of a CSV file. Raises `HostError` if
    it cannot be read.
    """
    check_file(path, LARGEST, HostError, f"The log {path}")
    if path.suffix.lower() in _MDF:
        raise HostError(
            f"The log {path} is a file of the kind MDF, which is not read; asammdf converts it: "
            f"asammdf.MDF('{path.name}').export('csv', '{path.stem}.csv', single_time_base=True, raster=0.01)."
        )
    if path.suffix.lower() in _PARQUET:
        return _read_parquet(path)
    detected = detect_dialect(path, dialect)
    content = Unpacked(path, LARGEST, HostError, f"The log {path}", detected.delimiter.encode())
    try:
        table = pd.read_csv(
            content,
            sep=detected.delimiter,
            decimal=detected.decimal,
            encoding=detected.encoding,
            skiprows=detected.first_row,
            header=None,
            na_values=["-", "--", "nan", "NaN", "n/a", ""],
            skip_blank_lines=True,
            skipinitialspace=True,
            names=[name or f"unnamed {k}" for k, name in enumerate(detected.names)],
            index_col=False,
            low_memory=False,
        )
    except UnicodeDecodeError as error:
        raise HostError(f"The log {path} is not written in {detected.encoding}: {error}.") from None
    except (pd.errors.ParserError, pd.errors.EmptyDataError, ValueError) as error:
        if cells := re.search(r"Expected (\d+) fields in line (\d+), saw (\d+)", str(error)):
            width, line, count = cells.groups()
            raise HostError(f"The log {path}, line {line}: {count} cells; the heading has {width}.") from None
        raise HostError(f"The log {path} is not a table: {one_line(str(error).strip()).rstrip('.')}.") from None
    if content.whole or len(table) < 2:
        return RawLog(path, table, detected.units, detected.first_row)
    note = "The last line has no line end, as where a log was cut: its row is left out."
    return RawLog(path, table.iloc[:-1], detected.units, detected.first_row, notes=(note,))


def _read_parquet(path: Path) -> RawLog:
    from pyarrow import ArrowException

    try:
        with opened_parquet(path, f"The log {path}") as file:
            content = file.read()
        # The metadata of pandas may be damaged, and is not needed: an index is a column too.
        table = content.replace_schema_metadata(None).to_pandas()
        table = table[[name for name in table if not name.startswith("__index_level_")]]
    except (ArrowException, OSError, ValueError, KeyError) as error:
        raise HostError(f"The log {path} is not a Parquet file: {one_line(str(error)).rstrip('.')}.") from None
    units = {
        f.name: f.metadata[b"unit"].decode(errors="replace")
        for f in content.schema
        if f.metadata and b"unit" in f.metadata
    }
    return RawLog(path, table, units, 0)
