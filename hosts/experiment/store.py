"""The store of an experiment: each result is written to a journal at once, and later with others to a table."""

import math
import time as clock
from contextlib import ExitStack
from pathlib import Path
from typing import Any, Generic, Protocol, TypeVar

from ali3.locks import locked
from hosts.common.closable import Closable
from hosts.experiment.journal import Journal

JOURNAL = "done"
_WRITE_INTERVAL = (2.0, 60.0)  # s: least and longest time between writes of a table
_WRITE_SHARE = 0.02  # of the elapsed time, between writes

R = TypeVar("R")
R_contra = TypeVar("R_contra", contravariant=True)


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
