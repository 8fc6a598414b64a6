"""Opens Parquet files after checking the memory that their content takes."""

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
    """A context with an open Parquet file.

    `name`: the file in sentences; `by_parts`: whether groups of rows are read one by one; `checksums`: whether those of
    pages are compared. Raises `HostError`: it is not a regular file, or would take too much memory. Errors of pyarrow
    on a damaged file are passed on.
    """
    import pyarrow.parquet as pq

    check_file(file, MOST_MEMORY, HostError, name)
    with pq.ParquetFile(file, page_checksum_verification=checksums) as table:
        groups = [table.metadata.row_group(k) for k in range(table.metadata.num_row_groups)]
        sizes = [group.total_byte_size + 8 * group.num_rows * group.num_columns for group in groups]
        check_memory(max(sizes, default=0) if by_parts else sum(sizes), HostError, name or str(file))
        yield table
