"""Reads the files of a car: a pipe never blocks, a huge file is not read, and each fault is one sentence."""

from __future__ import annotations

import csv
import math
import os
import stat
from collections.abc import Sequence
from pathlib import Path

from mbs.vehicle.errors import CarFileError

LARGEST = 1_000_000  # bytes of a car file
LARGEST_TABLE = 20_000_000  # bytes of a table beside it


def text_of(path: Path, largest: int = LARGEST) -> str:
    """Text of a file.

    Parameters
    ----------
    path : Path
        A regular file in UTF-8.
    largest : int
        Bytes.

    Raises
    ------
    CarFileError
        It is another thing, too large or no text.
    """
    try:
        found = path.stat()
        if not stat.S_ISREG(found.st_mode):
            kind = "a folder" if stat.S_ISDIR(found.st_mode) else "a pipe or device"
            raise CarFileError(f"{path} is {kind}; it must be a file.")
        if found.st_size > largest:
            raise CarFileError(f"{path} has {found.st_size} bytes; it must have at most {largest}.")
        return path.read_bytes().decode("utf-8-sig")
    except OSError as error:
        raise CarFileError(f"{path} cannot be read: {error.strerror or error}.") from error
    except UnicodeDecodeError as error:
        raise CarFileError(f"{path} is no text in UTF-8: byte {error.start} is not.") from error
    except ValueError as error:
        if isinstance(error, CarFileError):
            raise
        raise CarFileError(f"{str(path)!r} is no name of a file: {error}.") from error


def beside(folder: Path, name: str, key: str) -> Path:
    """A file of the car's folder.

    Parameters
    ----------
    folder : Path
        Of the car file.
    name : str
        As the car file gives it.
    key : str
        Key path that gives it.

    Raises
    ------
    CarFileError
        It lies elsewhere, or is not there.
    """
    if not name or "\0" in name or "\\" in name or Path(name).is_absolute() or ".." in Path(name).parts:
        raise CarFileError(
            f"{key} is {name!r}; it must be the name of a file in the folder of the car, without '..', '\\' or a drive."
        )
    path = folder / name
    if not os.path.lexists(path):
        raise CarFileError(f"{key} is {name!r}; there is no such file in {folder}.")
    if not path.resolve().is_relative_to(folder.resolve()):
        raise CarFileError(f"{key} is {name!r}; it leads out of the folder of the car.")
    return path


def table_of(path: Path, columns: Sequence[str], numbers: Sequence[str]) -> list[dict[str, str]]:
    """Rows of a table in CSV whose lines that begin with # are comments.

    Parameters
    ----------
    path : Path
        The table.
    columns : sequence of str
        That it must have.
    numbers : sequence of str
        Columns with finite numbers.

    Raises
    ------
    CarFileError
        A column is missing, a row has more or fewer fields than the first line, or a number is none.
    """
    lines = [(k, line) for k, line in enumerate(text_of(path, LARGEST_TABLE).splitlines(), 1) if line[:1] != "#"]
    kept = [(k, line) for k, line in lines if line.strip()]
    try:
        rows = [(k, row) for (k, _), row in zip(kept, csv.reader(line for _, line in kept), strict=True)]
    except (csv.Error, ValueError) as error:
        raise CarFileError(f"{path} is no table in CSV: {error}.") from error
    header = [name.strip() for name in rows[0][1]] if rows else []
    missing = [name for name in columns if name not in header]
    if missing:
        raise CarFileError(f"{path} has no column '{missing[0]}'; it must have {', '.join(columns)}.")
    if len(set(header)) < len(header):
        twice = next(name for name in header if header.count(name) > 1)
        raise CarFileError(f"{path} has the column '{twice}' twice.")
    found = []
    for k, row in rows[1:]:
        if len(row) != len(header):
            raise CarFileError(f"{path}, line {k} has {len(row)} fields; the first line has {len(header)}.")
        fields = dict(zip(header, row, strict=True))
        for name in numbers:
            if not _is_finite(fields[name]):
                raise CarFileError(f"{path}, line {k} has {fields[name]!r} for {name}; it must be a number.")
        found.append(fields)
    return found


def _is_finite(text: str) -> bool:
    try:
        return "_" not in text and math.isfinite(float(text))
    except ValueError:
        return False
