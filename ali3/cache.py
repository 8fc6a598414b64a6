"""The cache folder of the user, for files that commands can make again."""

import atexit
import functools
import os
import tempfile
from contextlib import ExitStack
from pathlib import Path

import platformdirs

from ali3.errors import FileError, reason
from ali3.temporary_folder import temporary_folder

VARIABLE = "ALI3_CACHE"


def cache_folder(*parts: str, name: str = "ali3", variable: str = VARIABLE) -> Path:
    """Path of a folder in the cache of the user; it is made if it does not exist.

    An environment variable names the cache; by default it is in the system's folder for caches. If that cannot be
    written, the folder is temporary and is removed when this process ends. Raises `FileError` if the variable names a
    folder that cannot be written.
    """
    path = os.environ.get(variable)
    try:
        cache = Path(path) if path else platformdirs.user_cache_path(name, appauthor=False, opinion=False)
        folder = cache.expanduser().joinpath(*parts)
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return folder.absolute()
    except (OSError, RuntimeError) as error:  # no home folder, or none to write to
        if path:
            message = reason(error) if isinstance(error, OSError) else str(error)
            raise FileError(f"{variable} is '{path}', which cannot be written: {message}.") from None
    folder = _temporary_cache(name).joinpath(*parts)
    folder.mkdir(parents=True, exist_ok=True)
    return folder


@functools.cache
def _temporary_cache(name: str) -> Path:
    stack = ExitStack()
    atexit.register(stack.close)
    return stack.enter_context(temporary_folder())
