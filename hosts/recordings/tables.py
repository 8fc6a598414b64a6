"""Tables of a recording that grow while a program runs and stay readable if it is killed.

Parquet has its directory at the end of a file, so an unfinished file cannot be read: rows are written as small whole
files, which are joined at the end. A CSV file grows by lines; a last one that is cut off is left out.
"""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import IO, Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from ali3.files import make_folder, reason, whole_file
from hosts.common.errors import HostError

TABLE = "inputs_outputs"
PARTS = "parts"
KEYS = ("time", "count", "epoch")
"""Columns before those of the FMU."""

_ROW_GROUP = 8192
_BLOCK = 4096


class Rows(NamedTuple):
    """Rows of a recording, in the order in which they were recorded.

    Parameters
    ----------
    time : ndarray of shape (n,)
        Time of the FMU, s; it falls where the car was reset or rewound.
    steps : ndarray of shape (n,)
        Steps computed so far, whole; the column ``count``.
    epoch : ndarray of shape (n,)
        Whole; one more at every reset, rewind, upright.
    values : ndarray of shape (n, m)
        Inputs of the step that ends there, then outputs after it.
    """

    time: NDArray[np.float64]
    steps: NDArray[np.int64]
    epoch: NDArray[np.int64]
    values: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.time)

    def chosen(self, which: Any) -> Rows:
        """Some of the rows, by an index or a mask."""
        return Rows(*(column[which] for column in self))


def joined(blocks: Sequence[Rows], columns: int) -> Rows:
    """One block of several; an empty one of so many columns if there are none."""
    if not blocks:
        none = np.zeros(0, dtype=np.int64)
        return Rows(np.zeros(0), none, none, np.zeros((0, columns)))
    return Rows(*(np.concatenate(parts) for parts in zip(*blocks, strict=True)))


class Table(Protocol):
    """A table that grows."""

    def write(self, rows: Rows) -> None:
        """Add rows, which are then safe from the end of the program."""

    def close(self, progress: Callable[[float], None]) -> None:
        """Finish the table; `progress` hears the share that is done."""


class ParquetTable:
    """A table in Parquet, of doubles but for `KEYS`.

    Parameters
    ----------
    folder : Path
    names : sequence of str
    units : mapping of str to str
        They stand in the file as metadata of the columns.
    """

    suffix = ".parquet"

    def __init__(self, folder: Path, names: Sequence[str], units: Mapping[str, str]) -> None:
        import pyarrow as pa

        kinds = (pa.float64(), pa.int64(), pa.int64())
        keys = [pa.field(name, kind) for name, kind in zip(KEYS, kinds, strict=True)]
        values = [pa.field(name, pa.float64(), metadata={"unit": units.get(name, "1")}) for name in names]
        self._schema = pa.schema(keys + values)
        self._folder, self._parts = folder, make_folder(folder / PARTS)
        self._count = 0

    def write(self, rows: Rows) -> None:
        self._count += 1
        with whole_file(self._parts / f"{self._count:06d}{self.suffix}") as made:
            self._write([rows], made)

    def close(self, progress: Callable[[float], None]) -> None:
        def blocks() -> Iterator[Rows]:
            """The rows of several parts at a time: groups of rows that are read at once should not be small."""
            held: list[Rows] = []
            for k, part in enumerate(sorted(self._parts.glob(f"*{self.suffix}")), start=1):
                held += parquet_blocks(part)
                if sum(map(len, held)) >= _ROW_GROUP:
                    yield joined(held, 0)
                    held = []
                progress(k / self._count)
            if held:
                yield joined(held, 0)

        with whole_file(self._folder / f"{TABLE}{self.suffix}") as made:
            self._write(blocks(), made)
        shutil.rmtree(self._parts, ignore_errors=True)

    def _write(self, blocks: Iterator[Rows] | Sequence[Rows], file: Path) -> None:
        import pyarrow as pa
        import pyarrow.parquet as pq

        # Measured numbers do not repeat: a dictionary of them is larger than they are.
        with pq.ParquetWriter(file, self._schema, compression="zstd", use_dictionary=False) as writer:
            for rows in blocks:
                columns = [rows.time, rows.steps, rows.epoch, *np.ascontiguousarray(rows.values.T)]
                writer.write_table(pa.Table.from_arrays([pa.array(c) for c in columns], schema=self._schema))


class CsvTable:
    """A table as text, with every number to the last bit.

    Parameters
    ----------
    folder : Path
    names : sequence of str
    units : mapping of str to str
        Not written: the recording's description has them.
    """

    suffix = ".csv"

    def __init__(self, folder: Path, names: Sequence[str], units: Mapping[str, str]) -> None:
        self._file: IO[str] = (folder / f"{TABLE}{self.suffix}").open("x", encoding="utf-8", newline="\n")
        self._file.write(",".join(f'"{name}"' for name in (*KEYS, *names)) + "\n")

    def write(self, rows: Rows) -> None:
        for time, count, epoch, values in zip(*(column.tolist() for column in rows), strict=True):
            self._file.write(f"{time!r},{count},{epoch}," + ",".join(map(repr, values)) + "\n")
        self._file.flush()

    def close(self, progress: Callable[[float], None]) -> None:
        self._file.close()


def blocks_of(folder: Path) -> Iterator[Rows]:
    """The rows of a recording, whether it was closed or not.

    Parameters
    ----------
    folder : Path

    Raises
    ------
    HostError
        There is no table, or one that cannot be read; with the file and the reason.
    """
    whole, text = folder / f"{TABLE}.parquet", folder / f"{TABLE}.csv"
    if whole.is_file():
        yield from parquet_blocks(whole)
    elif text.is_file():
        yield from _csv_blocks(text)
    elif (folder / PARTS).is_dir():
        for part in sorted((folder / PARTS).glob("*.parquet")):
            yield from parquet_blocks(part)
    else:
        raise HostError(f"{folder} has neither {whole.name} nor {text.name}, the table of a recording.")


def parquet_blocks(file: Path) -> Iterator[Rows]:
    """The rows of a Parquet file; see `blocks_of`."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    try:
        with pq.ParquetFile(file) as table:
            for batch in table.iter_batches(_BLOCK):
                time, count, epoch, *values = (column.to_numpy(zero_copy_only=False) for column in batch.columns)
                yield Rows(time, count, epoch, np.column_stack(values) if values else np.zeros((len(time), 0)))
    except (pa.ArrowException, OSError) as error:
        words = reason(error) if isinstance(error, OSError) else str(error)
        raise HostError(f"{file} cannot be read as Parquet: {' '.join(words.split())[:200]}.") from None


def _csv_blocks(file: Path) -> Iterator[Rows]:
    with file.open(encoding="utf-8") as text:
        columns = text.readline().count(",") + 1
        held: list[list[float]] = []
        for number, line in enumerate(text, start=2):
            if not line.endswith("\n"):  # the program was killed while it wrote
                break
            try:
                held.append([float(cell) for cell in line.split(",")])
            except ValueError as error:
                raise HostError(f"{file}, line {number}: {error}.") from None
            if len(held[-1]) != columns:
                raise HostError(f"{file}, line {number}: {len(held[-1])} values where there are {columns} columns.")
            if len(held) == _BLOCK:
                yield _of_lines(held)
                held = []
        if held:
            yield _of_lines(held)


def _of_lines(lines: list[list[float]]) -> Rows:
    table = np.array(lines)
    count, epoch = table[:, 1].astype(np.int64), table[:, 2].astype(np.int64)
    return Rows(np.ascontiguousarray(table[:, 0]), count, epoch, np.ascontiguousarray(table[:, 3:]))
