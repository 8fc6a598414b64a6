"""Reads the table of a log: CSV as data loggers write it, or Parquet."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from hosts.common.errors import HostError
from hosts.compare.csv_form import find_form
from hosts.compare.log_aliases import Form

_MOST_BYTES = 4_000_000_000
_MDF = (".mf4", ".mdf", ".dat")


@dataclass(frozen=True)
class RawLog:
    """A table as it is written.

    Parameters
    ----------
    path : Path
    table : pandas.DataFrame
        Columns by name.
    units : dict of str to str
        Where the file gives them.
    first_row : int
        Lines of the file before the first row.
    """

    path: Path
    table: pd.DataFrame
    units: dict[str, str]
    first_row: int

    def numbers(self, name: str) -> NDArray[np.float64]:
        """Values of a column of shape (n,), NaN where there is none.

        Raises
        ------
        HostError
            A cell is no number; with its row.
        """
        column = self.table[name]
        numbers = pd.to_numeric(column, errors="coerce")
        wrong = numbers.isna() & column.notna()
        if wrong.any():
            row = int(np.argmax(wrong.to_numpy()))
            raise HostError(
                f"The log {self.path}, line {row + self.first_row + 1}, column '{name}': "
                f"{str(column.iloc[row])[:40]!r} is no number."
            )
        values = np.array(numbers, dtype=np.float64)
        values[~np.isfinite(values)] = np.nan
        return values


def read_log(path: Path, form: Form) -> RawLog:
    """Read a log.

    Parameters
    ----------
    path : Path
        A file that ends in ``.parquet``, or CSV.
    form : Form
        What is known of a CSV file.

    Raises
    ------
    HostError
        It cannot be read; one sentence.
    """
    if not path.is_file():
        what = "is a folder; a log is a file" if path.is_dir() else "does not exist"
        raise HostError(f"The log {path} {what}.")
    if path.stat().st_size > _MOST_BYTES:
        raise HostError(f"The log {path} has more than {_MOST_BYTES / 1e9:g} GB; cut it into parts.")
    if path.suffix.lower() in _MDF:
        raise HostError(
            f"The log {path} is a file of the kind MDF, which is not read; asammdf converts it: "
            f"asammdf.MDF('{path.name}').export('csv', '{path.stem}.csv', single_time_base=True, raster=0.01)."
        )
    if path.suffix.lower() in (".parquet", ".pq"):
        return _read_parquet(path)
    found = find_form(path, form)
    try:
        table = pd.read_csv(
            path,
            sep=found.delimiter,
            decimal=found.decimal,
            encoding=found.encoding,
            skiprows=found.first_row,
            header=None,
            na_values=["-", "--", "nan", "NaN", "n/a", ""],
            skip_blank_lines=True,
            skipinitialspace=True,
            names=[name or f"unnamed {k}" for k, name in enumerate(found.names)],
            index_col=False,
            low_memory=False,
        )
    except UnicodeDecodeError as error:
        raise HostError(f"The log {path} is not written in {found.encoding}: {error}.") from None
    except (pd.errors.ParserError, pd.errors.EmptyDataError, ValueError) as error:
        raise HostError(f"The log {path} is no table: {' '.join(str(error).split())[:200]}.") from None
    return RawLog(path, table, found.units, found.first_row)


def _read_parquet(path: Path) -> RawLog:
    from pyarrow import ArrowException, parquet

    try:
        schema = parquet.read_schema(path)
        table = pd.read_parquet(path)
    except (ArrowException, OSError, ValueError) as error:
        raise HostError(f"The log {path} is no Parquet file: {' '.join(str(error).split())[:200]}.") from None
    units = {f.name: f.metadata[b"unit"].decode() for f in schema if f.metadata and b"unit" in f.metadata}
    if table.index.name is not None:
        table = table.reset_index()
    return RawLog(path, table, units, 0)
