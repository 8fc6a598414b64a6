"""Computes the values of derived variables from rows of the variables of the FMU."""

from collections import deque
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hosts.fmu.aliases.derived_variable import Derived, in_order

_ROWS = 3
"""That a rate of second order needs."""


class Derivation:
    """Computes derived variables.

    `names`: of the values that are there, ours where they have one. Its own `names` are those of the m variables that
    can be derived from them.
    """

    def __init__(self, derived: Sequence[Derived], names: Sequence[str]) -> None:
        self._derived = in_order([d for d in derived if d.ours not in names], names)[0]
        self.names = tuple(d.ours for d in self._derived)
        self._width = len(names)
        column = {name: k for k, name in enumerate((*names, *self.names))}
        self._arguments = [[column[a] if isinstance(a, str) else a for a in d.arguments] for d in self._derived]
        self._turning = [k for k, d in enumerate(self._derived) if d.how.turns]
        self._needs_past = any(d.how.needs_past for d in self._derived)
        self._past: deque[tuple[float, NDArray[np.float64]]] = deque(maxlen=_ROWS)
        self._last: NDArray[np.float64] | None = None

    def record(self, time: ArrayLike, values: ArrayLike) -> NDArray[np.float64]:
        """Of a whole run; rates are central differences.

        `time`: s, shape (n,); `values`: shape (n, number of names). Returns an array of shape (n, m).
        """
        t = np.asarray(time, np.float64)
        columns: list[NDArray[np.float64]] = list(np.asarray(values, np.float64).T)
        for derived, arguments in zip(self._derived, self._arguments, strict=True):
            column = derived.how.compute(t, *(columns[a] if isinstance(a, int) else a for a in arguments))
            columns.append(column if column.shape == t.shape else np.broadcast_to(column, t.shape))
        return np.array(columns[self._width :]).reshape(len(self.names), len(t)).T

    def live(self, time: float, values: ArrayLike) -> NDArray[np.float64]:
        """Of one row while a car is driven; rates are those of the last three rows, NaN in the first.

        `time`: s; with an earlier one than before the past is forgotten; `values`: shape (number of names,). Returns an
        array of shape (m,).
        """
        if self._past and time < self._past[-1][0]:
            self._past.clear()
            self._last = None
        elif self._past and time == self._past[-1][0]:
            self._past.pop()
        if not self._needs_past:
            self._past.clear()
        self._past.append((time, np.array(values, np.float64)))
        derived = self.record([t for t, _ in self._past], np.array([row for _, row in self._past]))[-1].copy()
        if self._last is not None and self._turning:
            turns = np.round((self._last[self._turning] - derived[self._turning]) / (2.0 * np.pi))
            derived[self._turning] += 2.0 * np.pi * turns
        self._last = derived
        return np.array(derived)
