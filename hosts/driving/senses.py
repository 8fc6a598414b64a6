"""The outputs of an FMU for a pilot: those that are costly to compute are read only where they are used."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from hosts.common.errors import HostError
from hosts.driving.simulated_fmu import SimulatedFmu

COSTLY = ("stress.", "bending_moment.")
"""Outputs that an FMU may compute on reading: they are read where a row is recorded or a pilot uses one."""


class _NoOutputError(HostError, KeyError):
    """A pilot uses an output that there is not."""

    __str__ = Exception.__str__


class Senses(Mapping[str, float]):
    """The outputs after a step by name.

    `all_rows`: whether the outputs of each step are recorded, so that none is read later than the others.
    """

    def __init__(self, fmu: SimulatedFmu, names: Sequence[str], all_rows: bool) -> None:
        self._places = {n: k for k, n in enumerate(names)}
        self.row = np.empty(len(names))
        later = [] if all_rows else [k for k, n in enumerate(names) if n.startswith(COSTLY)]
        self._later, self._fresh = frozenset(later), True
        self._parts = [
            (fmu.reader([names[k] for k in part]), np.empty(len(part)), np.array(part, dtype=np.intp))
            for part in ([k for k in range(len(names)) if k not in self._later], later)
        ]

    def read(self) -> None:
        """Read the outputs of now, but for costly ones."""
        self._fresh = not self._later
        self._take(0)

    def whole(self) -> NDArray[np.float64]:
        """All outputs of now."""
        if not self._fresh:
            self._fresh = True
            self._take(-1)
        return self.row

    def _take(self, part: int) -> None:
        read, into, places = self._parts[part]
        read(into)
        self.row[places] = into

    def __getitem__(self, name: str) -> float:
        try:
            place = self._places[name]
            return (self.whole() if place in self._later else self.row).item(place)
        except KeyError:
            raise _NoOutputError(f"The driver needs the output '{name}', which the FMU does not have.") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._places)

    def __len__(self) -> int:
        return len(self._places)
