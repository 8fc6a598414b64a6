"""Checks files that another file names: they lie below one folder, and their number and size are limited."""

import os
from pathlib import Path

from ali3.limits import limit_factor, raised
from ali3.message_text import brief
from ali3.reading import Error, check_file

MAX_FILES = 1000
"""Largest number of files that one file names directly or through others."""


class NamedFiles:
    """Files that a file names directly or through others.

    `folder`: must contain the files; `largest`: size of all, bytes; `error`: raised with one sentence.
    """

    def __init__(self, folder: str | os.PathLike[str], largest: int, error: Error) -> None:
        self._folder, self._error = Path(folder), error
        self._remaining_bytes, self._count = largest, 0

    def file(self, name: str, beside: Path, where: str = "") -> Path:
        """Path of a regular file that a file of the folder `beside` names; `where`: file and line of the name."""
        location = f"{where}: " if where else ""
        try:
            path = beside / name
            if not path.resolve().is_relative_to(self._folder.resolve()):
                raise self._error(f"{location}{brief(name)} is not below the folder {self._folder}.")
        except (OSError, ValueError, RuntimeError) as fault:  # RuntimeError: a cycle of links
            if isinstance(fault, self._error):
                raise
            raise self._error(f"{location}{brief(name)} is not a file name.") from None
        self._count += 1
        if self._count > raised(MAX_FILES):
            raise self._error(
                f"{location}more than {raised(MAX_FILES)} files are named; {brief(name)} is the first too many."
            )
        check_file(path, self._remaining_bytes, self._error, f"{location}{brief(name)}")
        self._remaining_bytes -= int(path.stat().st_size / limit_factor())
        return path
