"""Limits the memory that reading a file takes, also for compressed files."""

import gzip
import io
import os
import zlib
from pathlib import Path

from ali3.errors import FileError, reason
from ali3.limits import at_most, raised
from ali3.reading import MAX_LINE, Error, open_file

MOST_MEMORY = 4_000_000_000
"""Limit of the memory of a reader, bytes."""
_BYTES_PER_CELL = 24
"""Memory of a cell of a table besides its text: its number and the address of its text."""


def check_memory(needed: float, error: Error, name: str, most: int = MOST_MEMORY) -> None:
    """Check the memory that reading would take. `needed`: estimate, bytes; `error`, `name`: see `check_file`."""
    if needed > most and needed > raised(most):
        raise error(
            f"{name} would take about {needed:.3g} bytes of memory; it must take {at_most(needed, most, '.3g')}."
        )


class Unpacked(io.RawIOBase):
    """A limited stream of the bytes of a text file, which is unpacked if its name ends in ``.gz``.

    Reading raises `error` with one sentence if the file cannot be unpacked, has a zero byte, has a line of more than
    `MAX_LINE`, or would take too much memory.

    Parameters
    ----------
    file, largest, error, name
        See `check_file`; `largest`: size of the file itself, bytes.
    mark : bytes
        Separator of cells, each of which takes memory besides its text.
    zeros : bool
        Whether zero bytes are allowed, because the caller checks them.
    most : int
        Limit of the memory, bytes.

    Attributes
    ----------
    taken : int
        Bytes read so far.
    whole : bool
        Whether they end with a line end.
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
        self.taken = self._cells = self._line_length = 0
        self.whole = True
        self._file = open_file(file, largest, error, self._name)
        is_compressed = Path(file).suffix.lower() == ".gz"
        self._source = gzip.GzipFile(fileobj=self._file) if is_compressed else self._file

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
        check_memory(self.taken + _BYTES_PER_CELL * self._cells, self._error, self._name, self._most)
        self.whole = data.endswith((b"\n", b"\r")) if data else self.whole
        end = data.rfind(b"\n")
        self._line_length = self._line_length + len(data) if end < 0 else len(data) - end - 1
        if self._line_length > MAX_LINE:
            raise self._error(f"{self._name} has a line of more than {MAX_LINE} characters.")

    def close(self) -> None:
        self._source.close()
        self._file.close()
        super().close()
