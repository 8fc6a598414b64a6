"""Folders that are written whole or not at all, and folders that one program has for itself."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ali3.errors import FileError
from ali3.files import WRITING, make_folder, reason


@contextmanager
def whole_folder(folder: str | os.PathLike[str]) -> Iterator[Path]:
    """A folder to fill; when the block ends without an error it becomes `folder` at once.

    Parameters
    ----------
    folder : path
        That is not there. If another program makes it meanwhile, its folder stays.

    Yields
    ------
    Path
        A folder of the same name in a temporary one beside `folder`.

    Raises
    ------
    FileError
        With the folder and the reason, if it cannot be written; nothing is left.
    """
    target = Path(folder)
    parent = make_folder(target.parent)
    try:
        with tempfile.TemporaryDirectory(prefix=WRITING, dir=parent, ignore_cleanup_errors=True) as room:
            made = Path(room, target.name)
            made.mkdir()
            yield made
            try:
                made.rename(target)
            except OSError:
                if not target.is_dir():
                    raise
    except FileError:
        raise
    except OSError as error:
        raise FileError(f"{folder} cannot be written: {reason(error)}.") from error


@contextmanager
def locked(folder: str | os.PathLike[str], busy: str = "") -> Iterator[None]:
    """A folder, made if it is not there, that no other program has locked.

    The lock goes with the process that holds it, however it ends.

    Parameters
    ----------
    busy : str, optional
        What is said where another program has locked it; by default its end is waited for.

    Raises
    ------
    FileError
        Another program has locked it, or it cannot be written.
    """
    from filelock import FileLock, Timeout

    lock = FileLock(make_folder(folder) / ".lock", timeout=0 if busy else -1)
    try:
        lock.acquire()
    except Timeout:
        raise FileError(busy) from None
    except OSError as error:
        raise FileError(f"The folder {folder} cannot be written: {reason(error)}.") from None
    try:
        yield
    finally:
        lock.release()
