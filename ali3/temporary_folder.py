"""Temporary folders that are removed after the end of the program that made them, also after a crash."""

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
"""Parents from which abandoned folders were removed."""


@contextmanager
def temporary_folder(parent: str | os.PathLike[str] | None = None) -> Iterator[Path]:
    """Context with a folder that is removed at its end.

    The program locks the folder. If it is killed, the next program that makes a folder in the same parent removes it;
    not on Windows, nor on file systems without locks.

    `parent`: folder, by default the system's for temporary files. Raises `OSError` if no folder can be made there.
    """
    parent_folder = Path(tempfile.gettempdir() if parent is None else parent).absolute()
    if parent_folder not in _cleared:
        _cleared.add(parent_folder)
        _remove_abandoned(parent_folder)
    folder, lock = _locked_folder(parent_folder)
    owner = os.getpid()
    try:
        yield folder
    finally:
        if os.getpid() == owner:  # a forked process may end within the context
            shutil.rmtree(folder, ignore_errors=True)
            if lock >= 0:
                os.close(lock)


def _locked_folder(parent: Path) -> tuple[Path, int]:
    """A new folder, and the descriptor of its lock; -1 on Windows, where folders cannot be locked."""
    while True:
        folder = Path(tempfile.mkdtemp(prefix=PREFIX, dir=parent))
        if sys.platform == "win32":
            return folder, -1
        lock = os.open(folder, os.O_RDONLY)
        with suppress(OSError):
            fcntl.flock(lock, fcntl.LOCK_EX)
        if folder.exists():  # else another program removed it before it was locked
            return folder, lock
        os.close(lock)


def _remove_abandoned(parent: Path) -> None:
    """Remove the folders of programs that have ended."""
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
