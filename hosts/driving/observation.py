"""The outputs of an FMU for a pilot, read on demand, or all after each step if some are derived."""

from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from hosts.common.errors import HostError
from hosts.driving.simulated_fmu import SimulatedFmu


class _NoOutputError(HostError, KeyError):
    """A pilot needs an output that the FMU does not have."""

    __str__ = Exception.__str__


class Observation(Mapping[str, float]):
    """The present outputs by name, read on demand, because an FMU may compute some on reading.

    If some are derived, all are read after each step, because rates and whole turns need earlier rows.
    """

    def __init__(self, fmu: SimulatedFmu, names: Sequence[str]) -> None:
        self._fmu, self._indices = fmu, {n: k for k, n in enumerate(names)}
        self._each_step = any(n in fmu.derived for n in names)
        self._read_all, self.row = fmu.reader(names), np.empty(len(names))
        self._all_read, self._used_read = False, False
        self._used: dict[str, int] = {}
        """Index of each used output in the buffer."""
        self._buffer = np.empty(0)
        self._read_used: Callable[[NDArray[np.float64]], None] = lambda target: None

    def stepped(self) -> None:
        """Note that the FMU has made a step, so that values are read again."""
        self._all_read = self._used_read = False
        if self._each_step:
            self.read_all()

    def read_all(self) -> NDArray[np.float64]:
        """All present outputs."""
        if not self._all_read:
            self._read_all(self.row)
            self._all_read = True
        return self.row

    def __getitem__(self, name: str) -> float:
        if self._all_read and name in self._indices:
            return self.row.item(self._indices[name])
        if name not in self._used:
            if name not in self._indices:
                raise _NoOutputError(f"The driver needs the output '{name}', which the FMU does not have.")
            self._used[name] = len(self._used)
            self._read_used, self._buffer = self._fmu.reader(list(self._used)), np.empty(len(self._used))
            self._used_read = False
        if not self._used_read:
            self._read_used(self._buffer)
            self._used_read = True
        return self._buffer.item(self._used[name])

    def __iter__(self) -> Iterator[str]:
        return iter(self._indices)

    def __len__(self) -> int:
        return len(self._indices)
