"""Reads the files of a car: a pipe never blocks, a huge file is not read, and each fault is one sentence."""

from __future__ import annotations

import os
import stat
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
