"""Tables of a recording that grow while a program runs and stay readable if it is killed.

Parquet has its directory at the end of a file, so an unfinished file cannot be read: rows are written as small whole
files, which are joined at the end. A CSV file grows by lines; a last one that is cut off is left out.
"""

import shutil
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import IO, Protocol

import numpy as np

from ali3.files import atomic_file, make_folder
from hosts.recordings.tables import KEYS, PARTS, TABLE, Rows, joined, parquet_blocks

_ROW_GROUP = 16_384


class Table(Protocol):
    """A table that grows."""

    def write(self, rows: Rows) -> None:
        """Add rows, which then persist if the program is killed."""

    def close(self, progress: Callable[[float], object]) -> None:
        """Finish the table. `progress`: called with the finished share."""


class ParquetTable:
    """A Parquet table of doubles and `KEYS`. `units`: stored as metadata of the columns."""

    suffix = ".parquet"

    def __init__(self, folder: Path, names: Sequence[str], units: Mapping[str, str]) -> None:
        import pyarrow as pa

        types = (pa.float64(), pa.int64(), pa.int64())
        keys = [pa.field(name, kind) for name, kind in zip(KEYS, types, strict=True)]
        values = [pa.field(name, pa.float64(), metadata={"unit": units.get(name, "1")}) for name in names]
        self._schema = pa.schema(keys + values)
        # Doubles of a motion have similar upper bytes, counts equal differences.
        self._encoding = dict.fromkeys(["time", *names], "BYTE_STREAM_SPLIT")
        self._encoding |= dict.fromkeys(KEYS[1:], "DELTA_BINARY_PACKED")
        self._folder, self._parts = folder, make_folder(folder / PARTS)
        self._count = 0

    def write(self, rows: Rows) -> None:
        self._count += 1
        with atomic_file(self._parts / f"{self._count:06d}{self.suffix}") as temporary:
            self._write([rows], temporary, write_statistics=False, store_schema=False)  # they would be most of a part

    def close(self, progress: Callable[[float], object]) -> None:
        def blocks() -> Iterator[Rows]:
            """Rows of several parts at a time, for large row groups."""
            group: list[Rows] = []
            for k, file in enumerate(sorted(self._parts.glob(f"*{self.suffix}")), start=1):
                group += parquet_blocks(file, self._schema.names[len(KEYS) :])
                if sum(map(len, group)) >= _ROW_GROUP:
                    yield joined(group, 0)
                    group = []
                progress(k / self._count)
            if group:
                yield joined(group, 0)

        with atomic_file(self._folder / f"{TABLE}{self.suffix}") as temporary:
            self._write(blocks(), temporary)
        shutil.rmtree(self._parts, ignore_errors=True)

    def _write(self, blocks: Iterator[Rows] | Sequence[Rows], file: Path, **options: bool) -> None:
        import pyarrow as pa
        import pyarrow.parquet as pq

        compression = {"compression": "zstd", "use_dictionary": False, "column_encoding": self._encoding}
        with pq.ParquetWriter(file, self._schema, **compression, **options) as writer:
            for rows in blocks:
                columns = [rows.time, rows.steps, rows.epoch, *np.ascontiguousarray(rows.values.T)]
                arrays = [pa.array(c, from_pandas=True) for c in columns]  # not a number: not recorded
                writer.write_table(pa.Table.from_arrays(arrays, schema=self._schema))


class CsvTable:
    """A table as text, with every number to the last bit.

    `units`: not written: the recording's description has them.
    """

    suffix = ".csv"

    def __init__(self, folder: Path, names: Sequence[str], units: Mapping[str, str]) -> None:
        self._file: IO[str] = (folder / f"{TABLE}{self.suffix}").open("x", encoding="utf-8", newline="\n")
        self._file.write(",".join(f'"{name}"' for name in (*KEYS, *names)) + "\n")

    def write(self, rows: Rows) -> None:
        for time, count, epoch, values in zip(*(column.tolist() for column in rows), strict=True):
            cells = ("" if x != x else repr(x) for x in values)  # not a number: not recorded
            self._file.write(f"{time!r},{count},{epoch}," + ",".join(cells) + "\n")
        self._file.flush()

    def close(self, progress: Callable[[float], object]) -> None:
        self._file.close()
