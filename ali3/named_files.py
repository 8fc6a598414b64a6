"""Opens files that another file names, if they lie below a given folder, up to a largest number of them."""

import os
from pathlib import Path

from ali3.limits import factor, raised
from ali3.message_text import brief
from ali3.reading import Error, check_file

MOST_FILES = 1000
"""That one file names, those that are named by them included."""


class NamedFiles:
    """Files that a file names, and those that they name.

    `folder`: below which they lie; `largest`: bytes of all; `error`: what is raised, with one sentence.
    """

    def __init__(self, folder: str | os.PathLike[str], largest: int, error: Error) -> None:
        self._folder, self._error = Path(folder), error
        self._left, self._count = largest, 0

    def file(self, name: str, beside: Path, where: str = "") -> Path:
        """A regular file by its name in a file of the folder `beside`; `where`: file and line that name it."""
        location = f"{where}: " if where else ""
        try:
            path = beside / name
            if not path.resolve().is_relative_to(self._folder.resolve()):
                raise self._error(f"{location}{brief(name)} is not below the folder {self._folder}.")
        except (OSError, ValueError, RuntimeError) as fault:  # a circle of links is a RuntimeError
            if isinstance(fault, self._error):
                raise
            raise self._error(f"{location}{brief(name)} is not a file name.") from None
        self._count += 1
        if self._count > raised(MOST_FILES):
            raise self._error(
                f"{location}more than {raised(MOST_FILES)} files are named; {brief(name)} is the first too many."
            )
        check_file(path, self._left, self._error, f"{location}{brief(name)}")
        self._left -= int(path.stat().st_size / factor())
        return path
