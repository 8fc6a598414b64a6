"""Files of other programs, read by libraries."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from ali3.library_errors import read_by_library
from ali3.reading import check_file
from mbs.common.errors import ModelError

LARGEST = 2_000_000_000
"""Bytes of a file of matrices."""


def read_foreign(path: Path, reader: Callable[[Path], Any]) -> Any:
    """What a reader finds in a file; a `ModelError` if it cannot read it or a package is missing."""
    check_file(path, LARGEST, ModelError, path.name)
    with read_by_library(path.name, ModelError, extra="fem"):
        return reader(path)
