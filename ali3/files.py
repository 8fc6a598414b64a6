"""Writes files atomically: a file is complete or does not exist."""

import json
import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from ali3.errors import FileError, reason
from ali3.temporary_folder import temporary_folder


@contextmanager
def atomic_file(file: str | os.PathLike[str], make_parents: bool = True) -> Iterator[Path]:
    """Context with a path to write to, whose file replaces `file` if the block ends without an error.

    The path has the same name in a temporary folder beside `file`, so that programs can write the same file at the
    same time. A device or pipe is written to directly. `make_parents`: whether missing folders are made. Raises
    `FileError` with the file and the reason, if it cannot be written; an older file is then unchanged.
    """
    target = Path(os.path.realpath(file))  # a link stays a link
    _check_file(file, target)
    try:
        if target.exists() and not target.is_file():
            yield target
            return
        if make_parents:
            make_folder(target.parent)
        with temporary_folder(target.parent) as folder:
            temporary = folder / target.name
            yield temporary
            temporary.replace(target)
    except (FileError, BrokenPipeError):
        raise
    except OSError as error:
        raise FileError(f"{file} cannot be written: {reason(error)}.") from error


def write_text(file: str | os.PathLike[str], text: str) -> None:
    """Write a whole text file in UTF-8, in it bytes of names that are no characters as in JSON; see `atomic_file`."""
    with atomic_file(file) as temporary:
        temporary.write_text(text, encoding="utf-8", errors="backslashreplace")


def write_bytes(file: str | os.PathLike[str], content: bytes) -> None:
    """Write a whole file; see `atomic_file`."""
    with atomic_file(file) as temporary:
        temporary.write_bytes(content)


def write_json(file: str | os.PathLike[str], content: Any) -> None:
    """Write a whole JSON file in UTF-8, whose numbers are finite; see `atomic_file`."""
    write_text(file, json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False) + "\n")


def make_folder(folder: str | os.PathLike[str]) -> Path:
    """Make a folder and its parents, unless they exist. Raises `FileError` with the folder and the reason."""
    path = Path(folder)
    try:
        path.mkdir(parents=True, exist_ok=True)
    except FileExistsError as error:
        kind = "a link that leads to no folder" if Path(error.filename).is_symlink() else "a file"
        raise FileError(f"The folder {folder} cannot be made: {error.filename} is {kind}.") from None
    except OSError as error:
        raise FileError(f"The folder {folder} cannot be made: {reason(error)}.") from None
    return path


def check_writable(file: str | os.PathLike[str]) -> None:
    """Raise the `FileError` that writing a file would raise, before its content is computed."""
    target = Path(os.path.realpath(file))
    _check_file(file, target)
    _check_place(target.parent, f"{file} cannot be written")


def check_folder(folder: str | os.PathLike[str]) -> None:
    """Raise the `FileError` that making a folder, and writing to it, would raise."""
    _check_place(Path(os.path.realpath(folder)), f"{folder} cannot be written")


def _check_place(folder: Path, refusal: str) -> None:
    """Refuse a folder that cannot be made or written to."""
    try:
        nearest = next(place for place in (folder, *folder.parents) if place.exists())
        if not nearest.is_dir():
            raise FileError(f"The folder {folder} cannot be made: {nearest} is a file.")
        with tempfile.TemporaryFile(dir=nearest):
            pass
    except FileError:
        raise
    except OSError as error:
        raise FileError(f"{refusal}: {reason(error)}.") from None


def _check_file(file: str | os.PathLike[str], target: Path) -> None:
    """Refuse a folder and an invalid name."""
    try:
        if target.is_dir():
            raise FileError(f"{file} is a folder; it must be a file.")
        if target.is_symlink():  # only a loop is left of resolved links
            raise FileError(f"{file} cannot be written: it is a link that leads back to itself.")
    except FileError:
        raise
    except (OSError, ValueError) as error:
        message = reason(error) if isinstance(error, OSError) else str(error)
        raise FileError(f"{file} cannot be written: {message}.") from None
