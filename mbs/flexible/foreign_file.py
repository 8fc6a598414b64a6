"""Files of other programs, read by libraries."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from ali3.library_errors import read_by_library
from ali3.reading import check_file
from mbs.common.errors import ModelError

MAX_BYTES = 2_000_000_000
"""Bytes of a file of matrices."""


def read_foreign(path: Path, reader: Callable[[Path], Any]) -> Any:
    """Content of a file by a reader; raises `ModelError` if it cannot be read or a package is missing."""
    check_file(path, MAX_BYTES, ModelError, path.name)
    with read_by_library(path.name, ModelError, extra="fem"):
        return reader(path)
