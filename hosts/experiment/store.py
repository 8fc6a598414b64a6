"""The store of an experiment: each result is written to a journal at once and later, with others, to a table."""

import math
import time as clock
from contextlib import ExitStack
from pathlib import Path
from typing import Any, Generic, Protocol, TypeVar

from ali3.locks import locked
from hosts.common.closable import Closable
from hosts.experiment.journal import Journal

JOURNAL = "done"
_WRITE = (2.0, 60.0)  # s between parts of a table, at least and at most
_WRITE_PART = 0.02  # of the time so far

R = TypeVar("R")
R_contra = TypeVar("R_contra", contravariant=True)


class Table(Protocol[R_contra]):
    """The table that numerous results are moved to, such as the rows of a study in Parquet."""

    @property
    def is_full(self) -> bool:
        """Whether the collected results should be written now."""

    def lacks(self, name: str) -> bool:
        """Whether the table could have a result of this name but has none."""

    def take(self, name: str, result: R_contra) -> None:
        """Take a result for the next `write`."""

    def write(self) -> None:
        """Write the collected results to the disk. Raises `FileError`."""


class ResultStore(Closable, Generic[R]):
    """Results that stay in a folder, so that the same command goes on with the others; the folder is locked.

    `kind`: type of the results, see `Journal`; `does`: what the command does, in the sentence for another one that
    finds the folder in use; `again`: whether none of them is found.
    """

    def __init__(self, folder: Path, kind: Any, does: str, again: bool = False) -> None:
        busy = f"Another program {does} in {folder}; wait for it, or give another --out."
        with ExitStack() as stack:
            stack.enter_context(locked(folder, busy))
            self._journal: Journal[tuple[str, R]] = stack.enter_context(Journal(folder / JOURNAL, tuple[str, kind]))
            present = self._journal.read()
            self._found = {} if again else present
            self._held = stack.pop_all()
        self._table: Table[R] | None = None
        self._began = self._waits = math.inf  # s, of the first result, and of the first that is in the journal alone

    def find(self, name: str, key: str) -> R | None:
        """The stored result of a name if its key (`run_key`) is unchanged, else None."""
        was, result = self._found.get(name, ("", None))
        return result if was == key else None

    def add(self, name: str, key: str, result: R) -> None:
        """Keep a result; it takes the place of that of the same name. Raises `FileError`: it cannot be written."""
        self._journal.add(name, (key, result))
        if self._table is None:
            return
        self._table.take(name, result)
        now = clock.monotonic()
        self._began, self._waits = min(now, self._began), min(now, self._waits)
        if self._table.is_full or now - self._waits > min(max(_WRITE[0], _WRITE_PART * (now - self._began)), _WRITE[1]):
            self.write()

    def into(self, table: Table[R]) -> None:
        """Write results to a table from now on, first those that a killed command has left in the journal."""
        self._table = table
        for name, (_, result) in self._found.items():
            if table.lacks(name):
                table.take(name, result)
        self.write()

    def write(self) -> None:
        """Write the table, and clear the journal. Raises `FileError`: it cannot be written; the journal stays."""
        if self._table is not None:
            self._table.write()
        self.clear()

    def clear(self) -> None:
        """Clear the journal: the experiment has ended, or a table has its results."""
        self._journal.clear()
        self._waits = math.inf

    def close(self) -> None:
        """Close the journal and unlock the folder."""
        self._held.close()


def report_resumed(there: int, of: int, what: str) -> None:
    """Print how many results exist already; `what`: their name, such as ``tests``."""
    if there:
        print(f"{there} of {of} {what} are there; --again repeats them.", flush=True)
