"""Files of other programs, read by libraries."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from ali3.extras import missing_module
from ali3.reader_stops import reader_stops
from ali3.reading import check_file
from mbs.common.errors import ModelError

LARGEST = 8_000_000_000
"""Bytes of a file of matrices."""


def read_foreign(path: Path, reader: Callable[[Path], Any]) -> Any:
    """What a reader finds in a file; a `ModelError` if it cannot read it or a package is missing."""
    check_file(path, LARGEST, ModelError, path.name)
    try:
        return reader(path)
    except ModelError:  # a sentence of our own
        raise
    except ModuleNotFoundError as error:
        raise ModelError(f"{path.name} cannot be read. {missing_module(error, 'fem')}") from error
    except Exception as error:  # what a damaged file does to the readers is not declared
        raise ModelError(f"{path.name} cannot be read: {reader_stops(error)}") from error
