"""Records rows of a run, with jumps of inputs at rows and changes between them."""

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
"""Largest relative difference between the value of an input at the end of a step and at the next begin."""


def _table(shape: tuple[int, int], file: Path | None) -> NDArray[np.float64]:
    """Memory for a table, mapped from a file if one is given."""
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


def read_rows(file: Path, columns: int) -> NDArray[np.float64]:
    """Rows that a process has written, shape (n, columns); no rows if the file is damaged."""
    with suppress(OSError, ValueError):
        numbers = np.memmap(file, np.float64, "c")
        table: NDArray[np.float64] = np.asarray(numbers[: len(numbers) // columns * columns].reshape(-1, columns))
        count = float(table[0, 0])
        if 0.0 <= count <= len(table) - 1.0:
            rows = table[1 : 1 + int(count)]
            return rows.copy() if sys.platform == "win32" else rows  # a mapped file cannot be removed on Windows
    return np.empty((0, columns))


class RecordedRows:
    """Inputs and outputs at every nth step; the first row is that of the start.

    Parameters
    ----------
    observation : Observation
        Outputs, read at the start and after recorded steps.
    held : sequence of float, of length n
        Inputs at the start.
    used : sequence of int
        Indices of the inputs that are set.
    linear : sequence of int
        Indices of the inputs that are linear over a step.
    sizes : sequence of float, of length len(linear)
        Largest magnitudes of these.
    every : int
        Steps from row to row.
    steps : int
        Steps of the whole run.
    file : Path, optional
        A file into which rows are written at once, see `read_rows`.

    Attributes
    ----------
    done : int
        Number of steps made.
    refused : bool
        Whether the next step was refused.
    jumps : dict of int to list of float
        By row number, the inputs before a jump at its time, if the rows alone do not show it.
    lost : set of int
        Inputs that are not linear between rows.
    """

    def __init__(
        self,
        observation: Observation,
        held: Sequence[float],
        used: Sequence[int],
        linear: Sequence[int],
        sizes: Sequence[float],
        every: int,
        steps: int,
        file: Path | None = None,
    ) -> None:
        self._observation, self._inputs = observation, list(held)
        self._used, self._linear, self._sizes = list(used), list(linear), sizes
        self._every, self._changes = every, list[float]()
        table = _table((steps // every + 3, len(held) + len(observation)), file)
        self._count, self._values = table[0], table[1:]  # a file is read after the end of this process
        self._write(0)
        self.done, self.refused = 0, False
        self.jumps: dict[int, list[float]] = {}
        self.lost: set[int] = set()

    def begin(self, values: Sequence[float]) -> None:
        """Begin a step with these values of the inputs that are set."""
        row, between = divmod(self.done, self._every)
        before = self._inputs.copy()
        for k, value in zip(self._used, values, strict=True):
            self._inputs[k] = value
        if between:
            self.lost |= {k for k in self._used if self._jumps(k, before)}
            return
        self._values[row, : len(before)] = self._inputs
        if self._every > 1 or any(self._jumps(k, before) for k in (self._linear if row else self._used)):
            self.jumps[row] = before

    def _jumps(self, k: int, before: Sequence[float]) -> bool:
        x, y = self._inputs[k], before[k]
        return abs(x - y) > ROUND_OFF * (abs(x) + abs(y))

    def move(self, ends: Sequence[float], changes: Sequence[float]) -> None:
        """Move linear inputs over the step by `changes` to `ends`."""
        if self.done % self._every:
            slopes = zip(self._linear, changes, self._changes, self._sizes, strict=True)
            self.lost |= {
                k for k, change, change_before, size in slopes if abs(change - change_before) > ROUND_OFF * size
            }
        self._changes = list(changes)
        for k, end in zip(self._linear, ends, strict=True):
            self._inputs[k] = end

    def end(self) -> None:
        """End a step that was made, and record a row if one is due."""
        self.done += 1
        if self.done % self._every == 0:
            self._write(self.done // self._every)

    def _write(self, row: int) -> None:
        target, input_count = self._values[row], len(self._inputs)
        target[:input_count] = self._inputs
        target[input_count:] = self._observation.read_all()
        self._count[:1] = row + 1.0

    def close(self, last: bool) -> tuple[list[int], NDArray[np.float64]]:
        """Numbers of the steps with a row, and the rows. `last`: whether a last step that was made gets one."""
        rows = [*range(0, self.done + 1, self._every)]
        if last and self.done % self._every and not self.refused:
            self._write(len(rows))
            rows.append(self.done)
        return rows, self._values[: len(rows)]
