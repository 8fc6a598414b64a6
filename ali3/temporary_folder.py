"""Temporary folders that are removed with the program that made them, however it ends."""

import os
import shutil
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

if sys.platform != "win32":
    import fcntl

PREFIX = ".ali3-"
_cleared: set[Path] = set()


@contextmanager
def temporary_folder(parent: str | os.PathLike[str] | None = None) -> Iterator[Path]:
    """A folder that is there while the block runs.

    Its program holds a lock of it, which goes with the program. Where one was killed, the next that makes a folder
    beside it removes it; not on Windows, nor where the file system has no locks.

    `parent`: by default where temporary files go. Raises `OSError`: none can be made there.
    """
    parent_folder = Path(tempfile.gettempdir() if parent is None else parent).absolute()
    if parent_folder not in _cleared:
        _cleared.add(parent_folder)
        _clear(parent_folder)
    folder, lock = _locked_folder(parent_folder)
    owner = os.getpid()
    try:
        yield folder
    finally:
        if os.getpid() == owner:  # a process that was forked from it may end with the block open
            shutil.rmtree(folder, ignore_errors=True)
            if lock >= 0:
                os.close(lock)


def _locked_folder(parent: Path) -> tuple[Path, int]:
    while True:
        folder = Path(tempfile.mkdtemp(prefix=PREFIX, dir=parent))
        if sys.platform == "win32":
            return folder, -1
        lock = os.open(folder, os.O_RDONLY)
        with suppress(OSError):
            fcntl.flock(lock, fcntl.LOCK_EX)
        if folder.exists():  # else another program took it for one of the dead before it was locked
            return folder, lock
        os.close(lock)


def _clear(parent: Path) -> None:
    """Remove the folders of programs that are dead."""
    if sys.platform == "win32":
        return
    with suppress(OSError), os.scandir(parent) as entries:
        folders = [entry.path for entry in entries if entry.name.startswith(PREFIX)]
        for folder in folders:
            with suppress(OSError):
                lock = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW)
                try:
                    fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
                    shutil.rmtree(folder, ignore_errors=True)
                finally:
                    os.close(lock)
