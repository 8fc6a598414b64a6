"""The store of an experiment: each result is written to a journal at once under a key, later with others to a table."""

import hashlib
import math
import time as clock
from collections.abc import Iterable
from contextlib import ExitStack, suppress
from functools import cache
from io import BytesIO
from pathlib import Path
from typing import IO, Any, Generic, Protocol, TypeVar

from ali3.archives import LARGEST_ARCHIVE
from ali3.errors import FileError, reason
from ali3.files import atomic_file, make_folder
from ali3.frames import FrameError, read_frame, write_frame
from ali3.locks import locked
from ali3.reading import is_file, read_bytes
from hosts.common.closable import Closable
from hosts.common.errors import HostError
from hosts.common.program import program_digest

JOURNAL = "done"
_WRITE_INTERVAL = (2.0, 60.0)  # s: least and longest time between writes of a table
_WRITE_SHARE = 0.02  # of the elapsed time, between writes

_LARGEST_FILE = 8_000_000_000  # bytes, of a journal

R = TypeVar("R")
R_contra = TypeVar("R_contra", contravariant=True)


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


def run_key(fmu: Path, *settings: object, files: Iterable[Path] = ()) -> str:
    """A hash of the content of an FMU, of the settings of a run (their `repr`), and of the program.

    `files`: other files that a run reads, such as roads; missing ones are ignored.
    """
    present = [fmu, *filter(is_file, files)]
    contents = [_file_hash(file, (state := file.stat()).st_size, state.st_mtime_ns) for file in present]
    return hashlib.sha256(f"{contents} {settings!r} {program_digest()}".encode()).hexdigest()


@cache
def _file_hash(path: Path, size: int, modified: int) -> str:
    """The hash of a file, computed once. `size`, `modified`: bytes and time in ns, which identify its content."""
    return hashlib.sha256(read_bytes(path, LARGEST_ARCHIVE, HostError)).hexdigest()


class Table(Protocol[R_contra]):
    """The interface of a table for numerous results, such as the rows of a study in Parquet."""

    @property
    def is_full(self) -> bool:
        """Whether the collected results should be written now."""

    def lacks(self, name: str) -> bool:
        """Whether the table may have a result of this name, but does not."""

    def take(self, name: str, result: R_contra) -> None:
        """Add a result, which the next `write` writes."""

    def write(self) -> None:
        """Write the collected results to the disk. Raises `FileError`."""


class ResultStore(Closable, Generic[R]):
    """Results in a locked folder, so that the same command resumes with the others.

    `kind`: type of the results, see `Journal`; `does`: predicate of the command in the sentence on a folder in use;
    `again`: whether earlier results are ignored.
    """

    def __init__(self, folder: Path, kind: Any, does: str, again: bool = False) -> None:
        busy = f"Another program {does} in {folder}; wait for it, or give another --out."
        with ExitStack() as stack:
            stack.enter_context(locked(folder, busy))
            self._journal: Journal[tuple[str, R]] = stack.enter_context(Journal(folder / JOURNAL, tuple[str, kind]))
            present = self._journal.read()
            self._results = {} if again else present
            self._resources = stack.pop_all()
        self._table: Table[R] | None = None
        self._first_time = self._unwritten_since = math.inf  # s

    def find(self, name: str, key: str) -> R | None:
        """The stored result of a name if its key (`run_key`) is unchanged, else None."""
        stored_key, result = self._results.get(name, ("", None))
        return result if stored_key == key else None

    def add(self, name: str, key: str, result: R) -> None:
        """Store a result; it replaces that of the same name. Raises `FileError`: it cannot be written."""
        self._journal.add(name, (key, result))
        if self._table is None:
            return
        self._table.take(name, result)
        now = clock.monotonic()
        self._first_time, self._unwritten_since = min(now, self._first_time), min(now, self._unwritten_since)
        if self._table.is_full or now - self._unwritten_since > min(
            max(_WRITE_INTERVAL[0], _WRITE_SHARE * (now - self._first_time)), _WRITE_INTERVAL[1]
        ):
            self.write()

    def attach_table(self, table: Table[R]) -> None:
        """Write results to a table from now on, first those in the journal of a killed command."""
        self._table = table
        for name, (_, result) in self._results.items():
            if table.lacks(name):
                table.take(name, result)
        self.write()

    def write(self) -> None:
        """Write the table, then clear the journal. Raises `FileError`: the table cannot be written."""
        if self._table is not None:
            self._table.write()
        self.clear()

    def clear(self) -> None:
        """Clear the journal, after the end of the experiment, or when a table has its results."""
        self._journal.clear()
        self._unwritten_since = math.inf

    def close(self) -> None:
        """Close the journal and unlock the folder."""
        self._resources.close()


def report_resumed(count: int, total: int, name: str) -> None:
    """Print the number of existing results. `name`: such as ``tests``."""
    if count:
        print(f"{count} of {total} {name} are there; --again repeats them.", flush=True)
