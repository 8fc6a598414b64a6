"""Writes folders atomically, and removes folders of a cache that are no longer used."""

import os
import shutil
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from ali3.errors import FileError, reason
from ali3.files import make_folder
from ali3.temporary_folder import temporary_folder


@contextmanager
def atomic_folder(folder: str | os.PathLike[str]) -> Iterator[Path]:
    """Context with a temporary folder of the same name, which becomes `folder` if the block ends without an error.

    `folder`: does not exist yet; if another program makes it at the same time, that one stays. Raises `FileError` with
    the folder and the reason, if it cannot be written; no files stay behind.
    """
    target = Path(folder)
    parent = make_folder(target.parent)
    try:
        with temporary_folder(parent) as staging_folder:
            temporary = staging_folder / target.name
            temporary.mkdir()
            yield temporary
            try:
                temporary.rename(target)
            except OSError:
                if not target.is_dir():
                    raise
    except FileError:
        raise
    except OSError as error:
        raise FileError(f"{folder} cannot be written: {reason(error)}.") from error


def forget_oldest(cache: Path, kept: int, in_use: float = 0.0) -> None:
    """Remove the least recently used folders of a cache; another program may do so at the same time.

    `kept`: number of folders that stay; `in_use`: folders used within this time stay too, s.
    """
    use_times: dict[Path, float] = {}
    for folder in cache.iterdir():
        with suppress(FileNotFoundError):
            if folder.is_dir() and not folder.name.startswith("."):
                use_times[folder] = folder.stat().st_mtime
    for folder in sorted(use_times, key=use_times.__getitem__, reverse=True)[kept:]:
        if use_times[folder] <= time.time() - in_use:
            shutil.rmtree(folder, ignore_errors=True)
