"""The outputs of an FMU for a pilot: between recorded rows only used ones are read, or all if some are derived."""

from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from hosts.common.errors import HostError
from hosts.driving.simulated_fmu import SimulatedFmu


class _NoOutputError(HostError, KeyError):
    """A pilot uses an output that there is not."""

    __str__ = Exception.__str__


class Observation(Mapping[str, float]):
    """The outputs of now by name, read from the FMU when they are asked for: an FMU may compute some on reading.

    Where some are derived all are read after each step: rates and whole turns are made from those of the steps before.
    """

    def __init__(self, fmu: SimulatedFmu, names: Sequence[str]) -> None:
        self._fmu, self._places = fmu, {n: k for k, n in enumerate(names)}
        self._each_step = any(n in fmu.derived for n in names)
        self._read_all, self.row = fmu.reader(names), np.empty(len(names))
        self._all_read, self._used_read = False, False
        self._used: dict[str, int] = {}
        """Place of a used output in the buffer."""
        self._buffer = np.empty(0)
        self._read_used: Callable[[NDArray[np.float64]], None] = lambda into: None

    def stepped(self) -> None:
        """The FMU has made a step: what was read is that of before."""
        self._all_read = self._used_read = False
        if self._each_step:
            self.whole()

    def whole(self) -> NDArray[np.float64]:
        """All outputs of now."""
        if not self._all_read:
            self._read_all(self.row)
            self._all_read = True
        return self.row

    def __getitem__(self, name: str) -> float:
        if self._all_read and name in self._places:
            return self.row.item(self._places[name])
        if name not in self._used:
            if name not in self._places:
                raise _NoOutputError(f"The driver needs the output '{name}', which the FMU does not have.")
            self._used[name] = len(self._used)
            self._read_used, self._buffer = self._fmu.reader(list(self._used)), np.empty(len(self._used))
            self._used_read = False
        if not self._used_read:
            self._read_used(self._buffer)
            self._used_read = True
        return self._buffer.item(self._used[name])

    def __iter__(self) -> Iterator[str]:
        return iter(self._places)

    def __len__(self) -> int:
        return len(self._places)
