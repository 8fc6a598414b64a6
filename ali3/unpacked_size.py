"""Checks the unpacked size of a compressed file before or while it is read into memory."""

import gzip
import io
import os
import zlib
from pathlib import Path

from ali3.errors import FileError, reason
from ali3.limits import at_most, raised
from ali3.reading import LONGEST_LINE, Error, open_file

MOST_MEMORY = 4_000_000_000
"""Bytes that a reader may take."""
_CELL = 24
"""Bytes that a table takes for each of its cells, beside its text: its number, and where its text is."""


def check_memory(needed: float, error: Error, name: str, most: int = MOST_MEMORY) -> None:
    """Refuse what would take too much memory. `needed`: estimated, bytes; `error`, `name`: as of `check_file`."""
    if needed > most and needed > raised(most):
        raise error(
            f"{name} would take about {needed:.3g} bytes of memory; it must take {at_most(needed, most, '.3g')}."
        )


class Unpacked(io.RawIOBase):
    """The bytes of a text file, unpacked where its name ends in ``.gz``, within bounds.

    Wherever it is read, it raises `error` with one sentence: the file cannot be unpacked, has a zero byte, a line of
    more than `LONGEST_LINE`, or would take more memory than a reader may.

    Parameters
    ----------
    file, largest, error, name
        As of `check_file`; `largest`: bytes of the file as it is.
    mark : bytes
        What divides cells: each takes memory beside its text.
    zeros : bool
        Whether zero bytes may be in it: who reads says what it is.
    most : int
        Bytes of memory.

    Attributes
    ----------
    taken : int
        Bytes that came out so far.
    """

    def __init__(
        self,
        file: str | os.PathLike[str],
        largest: int,
        error: Error = FileError,
        name: str = "",
        mark: bytes = b"",
        zeros: bool = False,
        most: int = MOST_MEMORY,
    ) -> None:
        super().__init__()
        self._name, self._error = name or str(file), error
        self._mark, self._zeros, self._most = mark, zeros, most
        self.taken = self._cells = self._line = 0
        self._file = open_file(file, largest, error, self._name)
        packed = Path(file).suffix.lower() == ".gz"
        self._source = gzip.GzipFile(fileobj=self._file) if packed else self._file

    def readable(self) -> bool:
        return True

    def readinto(self, buffer: memoryview) -> int:  # type: ignore[override]
        try:
            data = self._source.read(len(buffer))
        except (EOFError, zlib.error, gzip.BadGzipFile) as fault:
            raise self._error(f"{self._name} cannot be unpacked: {fault}.") from None
        except OSError as fault:
            raise self._error(f"{self._name} cannot be read: {reason(fault)}.") from None
        self._check(data)
        buffer[: len(data)] = data
        return len(data)

    def _check(self, data: bytes) -> None:
        self.taken += len(data)
        if b"\0" in data and not self._zeros:
            raise self._error(f"{self._name} is not text: there is a zero byte in it.")
        self._cells += data.count(self._mark) if self._mark else 0
        check_memory(self.taken + _CELL * self._cells, self._error, self._name, self._most)
        end = data.rfind(b"\n")
        self._line = self._line + len(data) if end < 0 else len(data) - end - 1
        if self._line > LONGEST_LINE:
            raise self._error(f"{self._name} has a line of more than {LONGEST_LINE} characters.")

    def close(self) -> None:
        self._source.close()
        self._file.close()
        super().close()
