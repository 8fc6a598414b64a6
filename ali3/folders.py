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
    """A folder to fill; when the block ends without an error it becomes `folder` at once.

    `folder`: one that does not exist. If another program makes it meanwhile, its folder stays. Raises `FileError` with
    the folder and the reason, if it cannot be written; nothing is left. Result: a folder of the same name in a
    temporary one beside `folder`.
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


def forget_oldest(room: Path, kept: int, in_use: float = 0.0) -> None:
    """Remove the folders that were not used for the longest time, while another program may do the same.

    `kept`: how many stay; `in_use`: those that were used in so many seconds stay too, s.
    """
    use_times: dict[Path, float] = {}
    for folder in room.iterdir():
        with suppress(FileNotFoundError):
            if folder.is_dir() and not folder.name.startswith("."):
                use_times[folder] = folder.stat().st_mtime
    for folder in sorted(use_times, key=use_times.__getitem__, reverse=True)[kept:]:
        if use_times[folder] <= time.time() - in_use:
            shutil.rmtree(folder, ignore_errors=True)
