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
from hosts.compare.csv_dialect import find_dialect, unit_behind
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
    """Where the file gives them."""
    first_row: int
    """Lines of the file before the first row."""
    added: int = 0
    """Rows that the file does not have, from the record of the run that wrote it."""

    def with_jumps(self, record: RunRecord) -> RawLog:
        """With a row before each jump of an input that the record of a run knows; `HostError` if it is of another."""
        if not record.jumps:
            return self
        names = [str(name) for name in self.table.columns]
        last = names.index(record.outputs_from) if record.outputs_from in names else 0
        blocks, end = [], len(self.table)
        for k, before in rows_before_jumps(record, self.path, self.numbers(names[0]).tolist(), last - 1):
            row = self.table.iloc[[k]].copy()
            row.iloc[0, 1:last] = before
            blocks += [self.table.iloc[k:end], row]
            end = k
        table = pd.concat([self.table.iloc[:end], *reversed(blocks)])  # the index is that of the rows of the file
        return replace(self, table=table, added=len(record.jumps))

    def numbers(self, name: str) -> NDArray[np.float64]:
        """Values of a column of shape (n,), NaN where there is none.

        Raises `HostError`: a cell is not a number; with its row.
        """
        column = self.table[name]
        numbers = pd.to_numeric(column, errors="coerce")
        wrong = numbers.isna() & column.notna()
        if wrong.any():
            row = int(np.argmax(wrong.to_numpy()))
            cell = str(column.iloc[row])
            raise self.error(
                row, name, unit_behind(cell) or f"{brief(cell)} is not a number; a cell without one is empty."
            )
        values = np.array(numbers, dtype=np.float64)
        values[~np.isfinite(values)] = np.nan
        beyond = np.flatnonzero(np.abs(values) > LARGEST_NUMBER)
        if len(beyond):
            row = int(beyond[0])
            message = f"{values[row]:g} is too large; numbers up to {LARGEST_NUMBER:g} are read."
            raise self.error(row, name, message)
        return values

    def error(self, row: int, name: str, words: str) -> HostError:
        """What is wrong with a cell, with its line; of a row that is the heading once more, that."""
        cells = self.table.iloc[row].astype(str).str.strip()
        if all(str(cell).startswith(str(column)) for cell, column in zip(cells, self.table.columns, strict=True)):
            words = "the heading stands there again; cut the log there, each drive is compared by itself."
            return HostError(f"The log {self.path}, line {self.line(row)}: {words}")
        return HostError(f"The log {self.path}, line {self.line(row)}, column '{name}': {words}")

    def line(self, row: int) -> int:
        """Number of the line of a row in the file; empty lines are none of a table."""
        index = int(self.table.index[row])
        if self.path.suffix.lower() in _PARQUET:
            return index + 1
        with io.BufferedReader(Unpacked(self.path, LARGEST, HostError, f"The log {self.path}")) as stream:
            lines = (k for k, text in enumerate(stream, 1) if k > self.first_row and text.strip())
            return next(islice(lines, index, None), self.first_row + index + 1)


def read_log(path: Path, dialect: Dialect) -> RawLog:
    """Read a log.

    `path`: a file that ends in ``.parquet``, or CSV; `dialect`: what is known of a CSV file. Raises `HostError`: it
    cannot be read.
    """
    check_file(path, LARGEST, HostError, f"The log {path}")
    if path.suffix.lower() in _MDF:
        raise HostError(
            f"The log {path} is a file of the kind MDF, which is not read; asammdf converts it: "
            f"asammdf.MDF('{path.name}').export('csv', '{path.stem}.csv', single_time_base=True, raster=0.01)."
        )
    if path.suffix.lower() in _PARQUET:
        return _read_parquet(path)
    result = find_dialect(path, dialect)
    try:
        table = pd.read_csv(
            Unpacked(path, LARGEST, HostError, f"The log {path}", result.delimiter.encode()),
            sep=result.delimiter,
            decimal=result.decimal,
            encoding=result.encoding,
            skiprows=result.first_row,
            header=None,
            na_values=["-", "--", "nan", "NaN", "n/a", ""],
            skip_blank_lines=True,
            skipinitialspace=True,
            names=[name or f"unnamed {k}" for k, name in enumerate(result.names)],
            index_col=False,
            low_memory=False,
        )
    except UnicodeDecodeError as error:
        raise HostError(f"The log {path} is not written in {result.encoding}: {error}.") from None
    except (pd.errors.ParserError, pd.errors.EmptyDataError, ValueError) as error:
        if cells := re.search(r"Expected (\d+) fields in line (\d+), saw (\d+)", str(error)):
            width, line, count = cells.groups()
            raise HostError(f"The log {path}, line {line}: {count} cells; the heading has {width}.") from None
        raise HostError(f"The log {path} is not a table: {one_line(str(error).strip()).rstrip('.')}.") from None
    return RawLog(path, table, result.units, result.first_row)


def _read_parquet(path: Path) -> RawLog:
    from pyarrow import ArrowException

    try:
        with opened_parquet(path, f"The log {path}") as file:
            content = file.read()
        # What pandas has written beside the columns adds nothing: an index is a column too. It may be damaged.
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
