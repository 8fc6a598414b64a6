"""Locks a folder, so that one program at a time writes in it."""

import os
from collections.abc import Iterator
from contextlib import contextmanager

from filelock import FileLock, Timeout

from ali3.errors import FileError, reason
from ali3.files import make_folder


@contextmanager
def locked(folder: str | os.PathLike[str], busy: str = "") -> Iterator[None]:
    """Context that locks a folder, which is made if it does not exist.

    The lock is released when the process ends in any way.

    `busy`: message of a `FileError` that is raised if another program has locked the folder; by default this waits
    until it is free. Raises `FileError` if the folder cannot be written.
    """
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
