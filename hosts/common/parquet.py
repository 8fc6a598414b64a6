"""Parquet files, measured unpacked before they are read."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from ali3.reading import check_file
from ali3.unpacked_size import MOST_MEMORY, check_memory
from hosts.common.errors import HostError

if TYPE_CHECKING:
    import pyarrow.parquet as pq


@contextmanager
def opened_parquet(
    file: Path, name: str = "", by_parts: bool = False, checksums: bool = False
) -> Iterator[pq.ParquetFile]:
    """A Parquet file that can be read.

    `name`: how a sentence calls it; `by_parts`: whether it is read one group of rows after the other;
    `checksums`: whether its pages are checked by them. Raises `HostError`: it is not a regular file, or would take
    too much memory; what pyarrow raises on a damaged one passes.
    """
    import pyarrow.parquet as pq

    check_file(file, MOST_MEMORY, HostError, name)
    with pq.ParquetFile(file, page_checksum_verification=checksums) as table:
        groups = [table.metadata.row_group(k) for k in range(table.metadata.num_row_groups)]
        sizes = [group.total_byte_size + 8 * group.num_rows * group.num_columns for group in groups]
        check_memory(max(sizes, default=0) if by_parts else sum(sizes), HostError, name or str(file))
        yield table
