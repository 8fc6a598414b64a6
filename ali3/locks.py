"""Locks a folder, so that one program at a time writes in it."""

import os
from collections.abc import Iterator
from contextlib import contextmanager

from filelock import FileLock, Timeout

from ali3.errors import FileError, reason
from ali3.files import make_folder


@contextmanager
def locked(folder: str | os.PathLike[str], busy: str = "") -> Iterator[None]:
    """A folder, made if it is not there, that no other program has locked.

    The lock goes with the process that holds it, however it ends.

    `busy`: what is said where another program has locked it; by default its end is waited for. Raises `FileError`:
    another program has locked it, or it cannot be written.
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
