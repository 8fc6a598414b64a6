"""Reads rows of a recording from its table; see `hosts.recordings.written_tables` for writing."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import islice, zip_longest
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ali3.errors import reason
from ali3.message_text import brief, one_line
from ali3.tables import TextTable
from hosts.common.errors import HostError
from hosts.common.parquet import opened_parquet

TABLE = "inputs_outputs"
PARTS = "parts"
KEYS = ("time", "count", "epoch")
"""Columns before those of the FMU."""

_BLOCK = 4096


class Rows(NamedTuple):
    """Rows of a recording, in the order in which they were recorded."""

    time: NDArray[np.float64]
    """Shape (n,): time of the FMU, s; it decreases at resets and rewinds."""
    steps: NDArray[np.int64]
    """Shape (n,): steps computed so far; the column ``count``."""
    epoch: NDArray[np.int64]
    """Shape (n,): number of resets, rewinds and uprights so far."""
    values: NDArray[np.float64]
    """Shape (n, m): inputs of the step that ends there, then outputs after it; NaN where not recorded."""

    def __len__(self) -> int:
        return len(self.time)

    def selected(self, selection: Any) -> Rows:
        """Some of the rows, by an index or a mask."""
        return Rows(*(column[selection] for column in self))


def recorded(steps: ArrayLike, begins: ArrayLike, every: ArrayLike) -> NDArray[np.bool_]:
    """Which values of rows are recorded.

    `steps`: steps computed up to each row, shape (n,); `begins`: whether an epoch begins with the row, of which all
    values are recorded, shape (n,); `every`: steps between recorded values of each column, shape (m,). Returns
    an array of shape (n, m).
    """
    due = np.asarray(steps)[:, np.newaxis] % np.asarray(every) == 0
    is_recorded: NDArray[np.bool_] = due | np.asarray(begins, dtype=bool)[:, np.newaxis]
    return is_recorded


def joined(blocks: Sequence[Rows], columns: int) -> Rows:
    """One block of several. `columns`: number of columns of an empty one."""
    if not blocks:
        none = np.zeros(0, dtype=np.int64)
        return Rows(np.zeros(0), none, none, np.zeros((0, columns)))
    return Rows(*(np.concatenate(parts) for parts in zip(*blocks, strict=True)))


def blocks_of(folder: Path, names: Sequence[str]) -> Iterator[Rows]:
    """The rows of a recording, closed or not; `HostError` with file and reason. `names`: of columns behind `KEYS`."""
    parquet_file, csv_file = folder / f"{TABLE}.parquet", folder / f"{TABLE}.csv"
    if parquet_file.is_file():
        yield from parquet_blocks(parquet_file, names)
    elif csv_file.is_file():
        yield from _csv_blocks(csv_file, names)
    elif (folder / PARTS).is_dir():
        read = 0
        for part in sorted((folder / PARTS).glob("*.parquet")):
            if parquet_file.is_file() and not part.is_file():  # the parts have been joined
                yield from _rows_after(parquet_blocks(parquet_file, names), read)
                return
            for rows in parquet_blocks(part, names):
                read += len(rows)
                yield rows
    else:
        raise HostError(f"{folder} has neither {parquet_file.name} nor {csv_file.name}, the table of a recording.")


def _rows_after(blocks: Iterator[Rows], count: int) -> Iterator[Rows]:
    """Rows of blocks without the first `count`."""
    for rows in blocks:
        to_skip = max(0, count - len(rows))
        if count < len(rows):
            yield rows.selected(slice(count, None))
        count = to_skip


def _check_names(file: Path, columns: Sequence[str], names: Sequence[str]) -> None:
    """Refuse a table of another recording."""
    for actual, expected in zip_longest(columns, (*KEYS, *names), fillvalue="no column"):
        if actual != expected:
            raise HostError(
                f"{file} is of another recording: it has {brief(actual)}, its description {brief(expected)}."
            )


def parquet_blocks(file: Path, names: Sequence[str]) -> Iterator[Rows]:
    """The rows of a Parquet file; see `blocks_of`."""
    import pyarrow as pa

    try:
        with opened_parquet(file, by_parts=True) as table:
            if not all(pa.types.is_floating(f.type) or pa.types.is_integer(f.type) for f in table.schema_arrow):
                raise HostError(f"{file} is not a table of a recording: a column does not hold numbers.")
            _check_names(file, table.schema_arrow.names, names)
            for batch in table.iter_batches(_BLOCK):
                time, count, epoch, *values = (column.to_numpy(zero_copy_only=False) for column in batch.columns)
                yield Rows(time, count, epoch, np.column_stack(values) if values else np.zeros((len(time), 0)))
    except (pa.ArrowException, OSError, UnicodeDecodeError) as error:
        message = reason(error) if isinstance(error, OSError) else str(error)
        raise HostError(f"{file} cannot be read as Parquet: {one_line(message).rstrip('.')}.") from None


def _csv_blocks(file: Path, names: Sequence[str]) -> Iterator[Rows]:
    table = TextTable(file, HostError, known=KEYS, whole=True)
    _check_names(file, table.names, names)
    rows = table.rows()
    keys = len(KEYS)
    full = (row._replace(cells=row.cells[:keys] + [cell or "nan" for cell in row.cells[keys:]]) for row in rows)
    while block := [table.numbers(row, finite=False) for row in islice(full, _BLOCK)]:
        if not (np.abs([line[:keys] for line in block]) < 2.0**53).all():  # beyond this doubles skip integers
            raise HostError(f"{file}: a time, count or epoch is not a number that a recording has.")
        yield _rows_of_lines(block)


def _rows_of_lines(lines: list[list[float]]) -> Rows:
    table = np.array(lines)
    count, epoch = table[:, 1].astype(np.int64), table[:, 2].astype(np.int64)
    return Rows(np.ascontiguousarray(table[:, 0]), count, epoch, np.ascontiguousarray(table[:, 3:]))
