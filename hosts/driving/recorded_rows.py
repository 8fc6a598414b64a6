"""Rows of a run while it goes on: what inputs do at them and between them."""

import sys
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ali3.errors import reason
from hosts.common.errors import HostError
from hosts.driving.observation import Observation

ROUND_OFF = 1e-9
"""Of a value that is reached at the end of a step and set again for the next; more is a jump."""


def _table(shape: tuple[int, int], file: Path | None) -> NDArray[np.float64]:
    """Memory for a table, which is that of a file where one is given."""
    if file is None or not all(shape):
        return np.empty(shape)
    try:
        file.touch()
        with file.open("r+b") as opened:
            opened.truncate(8 * shape[0] * shape[1])
            return np.asarray(np.memmap(opened, np.float64, "r+", shape=shape))
    except OSError as error:
        size = 8e-6 * shape[0] * shape[1]
        raise HostError(f"The rows of the run take {size:.3g} MB, which cannot be kept: {reason(error)}.") from None


def kept_rows(file: Path, columns: int) -> NDArray[np.float64]:
    """Rows that a process wrote, of shape (n, columns); none where it has spoilt them."""
    with suppress(OSError, ValueError):
        numbers = np.memmap(file, np.float64, "c")
        table: NDArray[np.float64] = np.asarray(numbers[: len(numbers) // columns * columns].reshape(-1, columns))
        count = float(table[0, 0])
        if 0.0 <= count <= len(table) - 1.0:
            rows = table[1 : 1 + int(count)]
            return rows.copy() if sys.platform == "win32" else rows  # where a mapped file cannot be removed
    return np.empty((0, columns))


class RecordedRows:
    """Inputs and outputs at every nth step; the first row is that of the start.

    Parameters
    ----------
    observation : Observation
        Outputs, read at the start.
    held : sequence of float, of length n
        Inputs at the start.
    straight : sequence of int
        Which of these go straight over a step.
    sizes : sequence of float, of length len(straight)
        Their largest values.
    every : int
        Steps from row to row.
    most : int
        Steps of the whole run.
    kept : Path, optional
        A file in which the rows are written at once, as `kept_rows` reads them.

    Attributes
    ----------
    done : int
        Steps that were made.
    refused : bool
        Whether the last one was refused.
    jumps : dict of int to list of float
        By the number of a row: inputs before a jump at its time, where the row alone does not show them.
    lost : set of int
        Inputs that moved between the rows otherwise than the rows show.
    """

    def __init__(
        self,
        observation: Observation,
        held: Sequence[float],
        used: Sequence[int],
        straight: Sequence[int],
        sizes: Sequence[float],
        every: int,
        most: int,
        kept: Path | None = None,
    ) -> None:
        self._senses, self._held = observation, list(held)
        self._used, self._straight, self._sizes = list(used), list(straight), sizes
        self._every, self._changes = every, list[float]()
        table = _table((most // every + 3, len(held) + len(observation)), kept)
        self._count, self._values = table[0], table[1:]  # in a file, for who reads it after the end of this process
        self._write(0)
        self.done, self.refused = 0, False
        self.jumps: dict[int, list[float]] = {}
        self.lost: set[int] = set()

    def begin(self, values: Sequence[float]) -> None:
        """A step begins with these values of the inputs that are set."""
        row, between = divmod(self.done, self._every)
        before = self._held.copy()
        for k, value in zip(self._used, values, strict=True):
            self._held[k] = value
        if between:
            self.lost |= {k for k in self._used if self._jumps(k, before)}
            return
        self._values[row, : len(before)] = self._held
        if self._every > 1 or any(self._jumps(k, before) for k in (self._straight if row else self._used)):
            self.jumps[row] = before

    def _jumps(self, k: int, before: Sequence[float]) -> bool:
        x, y = self._held[k], before[k]
        return abs(x - y) > ROUND_OFF * (abs(x) + abs(y))

    def move(self, ends: Sequence[float], changes: Sequence[float]) -> None:
        """Over the step those that go straight change by `changes` and reach `ends`."""
        if self.done % self._every:
            turns = zip(self._straight, changes, self._changes, self._sizes, strict=True)
            self.lost |= {k for k, new, old, size in turns if abs(new - old) > ROUND_OFF * size}
        self._changes = list(changes)
        for k, end in zip(self._straight, ends, strict=True):
            self._held[k] = end

    def end(self) -> None:
        """The step was made, and its outputs were read."""
        self.done += 1
        if self.done % self._every == 0:
            self._write(self.done // self._every)

    def _write(self, row: int) -> None:
        into, inputs = self._values[row], len(self._held)
        into[:inputs] = self._held
        into[inputs:] = self._senses.whole()
        self._count[:1] = row + 1.0

    def close(self, last: bool) -> tuple[list[int], NDArray[np.float64]]:
        """The steps that have a row, and the rows. `last`: whether the last step has one if none was refused."""
        rows = [*range(0, self.done + 1, self._every)]
        if last and self.done % self._every and not self.refused:
            self._write(len(rows))
            rows.append(self.done)
        return rows, self._values[: len(rows)]
