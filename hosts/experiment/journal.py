"""A file of results, each written at the end of its run, so that a kill loses only unfinished runs."""

from contextlib import suppress
from io import BytesIO
from pathlib import Path
from typing import IO, Any, Generic, TypeVar

from ali3.errors import FileError, reason
from ali3.files import atomic_file, make_folder
from ali3.frames import FrameError, read_frame, write_frame
from ali3.reading import read_bytes
from hosts.common.closable import Closable

_LARGEST_FILE = 8_000_000_000  # bytes

R = TypeVar("R")


class Journal(Closable, Generic[R]):
    """A file of results with keys; of several results with one key the last is valid.

    `kind`: type of the results, one that `ali3.frames` can write. One program at a time writes to a journal.
    """

    def __init__(self, file: Path, kind: Any) -> None:
        self._file, self._types = file, {0: tuple[str, kind]}
        self._stream: IO[bytes] | None = None

    def close(self) -> None:
        """Close the file."""
        if self._stream is not None:
            self._stream.close()
            self._stream = None

    def read(self) -> dict[str, R]:
        """Read all results by their keys. Results from the first damaged one on are removed from the file."""
        if not self._file.is_file():
            return {}
        stream = BytesIO(read_bytes(self._file, _LARGEST_FILE))
        results: dict[str, R] = {}
        end = count = 0
        with suppress(EOFError, FrameError):
            while True:
                key, result = read_frame(stream, self._types)[1]
                results[key] = result
                end, count = stream.tell(), count + 1
        if end < len(stream.getbuffer()) or len(results) < count:
            with atomic_file(self._file) as temporary, temporary.open("wb") as file:
                for item in results.items():
                    write_frame(file, 0, item)
        return results

    def add(self, key: str, result: R) -> None:
        """Write a result. Raises `FileError`: it cannot be written."""
        try:
            if self._stream is None:
                make_folder(self._file.parent)
                self._stream = self._file.open("ab")
            write_frame(self._stream, 0, (key, result))
        except OSError as error:
            raise FileError(f"{self._file} cannot be written: {reason(error)}.") from None

    def clear(self) -> None:
        """Remove all results."""
        self.close()
        self._file.unlink(missing_ok=True)
