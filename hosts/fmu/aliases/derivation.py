"""Computes the values of derived variables from rows of the variables of the FMU."""

from collections import deque
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hosts.fmu.aliases.derived_variable import Derived, sort_derived

_ROWS = 3
"""Rows for a difference quotient of second order."""


class Derivation:
    """Computes derived variables.

    `names`: names of the available variables, ALi3 names if they have an alias. The attribute `names` has the m
    variables that can be derived from them.
    """

    def __init__(self, derived: Sequence[Derived], names: Sequence[str]) -> None:
        self._derived = sort_derived([d for d in derived if d.name not in names], names)[0]
        self.names = tuple(d.name for d in self._derived)
        self._width = len(names)
        column = {name: k for k, name in enumerate((*names, *self.names))}
        self._arguments = [[column[a] if isinstance(a, str) else a for a in d.arguments] for d in self._derived]
        self._wrapping = [k for k, d in enumerate(self._derived) if d.function.wraps]
        self._needs_past = any(d.function.needs_past for d in self._derived)
        self._past: deque[tuple[float, NDArray[np.float64]]] = deque(maxlen=_ROWS)
        self._last: NDArray[np.float64] | None = None

    def record(self, time: ArrayLike, values: ArrayLike) -> NDArray[np.float64]:
        """Values of the derived variables in a whole run; rates are central differences.

        `time`: s, shape (n,); `values`: shape (n, number of names). Returns an array of shape (n, m).
        """
        t = np.asarray(time, np.float64)
        columns: list[NDArray[np.float64]] = list(np.asarray(values, np.float64).T)
        for derived, arguments in zip(self._derived, self._arguments, strict=True):
            column = derived.function.compute(t, *(columns[a] if isinstance(a, int) else a for a in arguments))
            columns.append(column if column.shape == t.shape else np.broadcast_to(column, t.shape))
        return np.array(columns[self._width :]).reshape(len(self.names), len(t)).T

    def update(self, time: float, values: ArrayLike) -> NDArray[np.float64]:
        """Append a row of a drive; its derived values, with rates from the last three rows, NaN in the first.

        `time`: s; a time before that of the last row drops all rows; `values`: shape (number of names,). Returns an
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
        if self._last is not None and self._wrapping:
            turns = np.round((self._last[self._wrapping] - derived[self._wrapping]) / (2.0 * np.pi))
            derived[self._wrapping] += 2.0 * np.pi * turns
        self._last = derived
        return np.array(derived)
