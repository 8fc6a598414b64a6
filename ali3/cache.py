"""Where commands keep what they have made and can make again."""

from __future__ import annotations

import atexit
import os
import sys
import tempfile
from pathlib import Path

from ali3.errors import FileError
from ali3.files import reason

VARIABLE = "ALI3_CACHE"


def cache_folder(*parts: str) -> Path:
    """A folder in the cache of the user, made if it is not there.

    The environment variable ``ALI3_CACHE`` names the cache; else it is the folder ``ali3`` where the system keeps
    caches. Where none can be written, the folder is a temporary one that goes when this process ends.

    Parameters
    ----------
    parts : str
        Names of folders inside the cache.

    Raises
    ------
    FileError
        ``ALI3_CACHE`` names a folder that cannot be written.
    """
    given = os.environ.get(VARIABLE)
    try:
        folder = (Path(given) if given else _usual() / "ali3").joinpath(*parts)
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return folder.absolute()
    except (OSError, RuntimeError) as error:  # no home folder, or none to write to
        if given:
            words = reason(error) if isinstance(error, OSError) else str(error)
            raise FileError(f"{VARIABLE} is '{given}', which cannot be written: {words}.") from None
    temporary = tempfile.TemporaryDirectory(prefix="ali3-", ignore_cleanup_errors=True)
    atexit.register(temporary.cleanup)
    folder = Path(temporary.name).joinpath(*parts)
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def _usual() -> Path:
    """The folder of all caches of this user."""
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local")
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches"
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
