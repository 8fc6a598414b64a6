"""An operand of an expression: a number or a signal over time, with its unit."""

from __future__ import annotations

import operator
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from hosts.common.errors import HostError

Array: TypeAlias = NDArray[np.float64]
NONE = "1"
ANY = "any unit"
"""Unit of a signal whose unit is not known yet; it can be added to any other."""
_SINGLE_UNIT = re.compile(r"[^/.* ]+")


@dataclass(frozen=True)
class Quantity:
    """A signal with its times, or a number."""

    text: str
    """As in the expression."""
    values: Array
    """Shape (n,); of a number ()."""
    unit: str = NONE
    time: Array | None = None
    """Times of a signal, shape (n,), s; None: a number."""

    def __add__(self, other: Quantity) -> Quantity:
        return self._combined(other, "+", operator.add, self._common_unit(other, "+"))

    def __sub__(self, other: Quantity) -> Quantity:
        return self._combined(other, "-", operator.sub, self._common_unit(other, "-"))

    def __mul__(self, other: Quantity) -> Quantity:
        a, b = self.unit, other.unit
        unit = b if a == NONE else a if b == NONE else f"{_parenthesise(a)}.{_parenthesise(b)}"
        return self._combined(other, "*", operator.mul, unit)

    def __truediv__(self, other: Quantity) -> Quantity:
        a, b = self.unit, other.unit
        unit = a if b == NONE else NONE if a == b else f"{_parenthesise(a)}/{_parenthesise(b)}"
        return self._combined(other, "/", operator.truediv, unit)

    def __neg__(self) -> Quantity:
        return Quantity(f"-{self.text}", -self.values, self.unit, self.time)

    def __pos__(self) -> Quantity:
        return self

    def __abs__(self) -> Quantity:
        return Quantity(f"abs({self.text})", np.abs(self.values), self.unit, self.time)

    def _combined(self, other: Quantity, sign: str, apply: Callable[[Array, Array], Array], unit: str) -> Quantity:
        time = other.time if self.time is None else self.time
        return Quantity(f"{self.text} {sign} {other.text}", np.asarray(apply(self.values, other.values)), unit, time)

    def _common_unit(self, other: Quantity, sign: str) -> str:
        """The unit of a sum. Raises `HostError` if the units of its terms differ."""
        if ANY in (self.unit, other.unit):
            return ANY
        if self.unit != other.unit:
            raise HostError(
                f"'{self.text}' in {self.unit} {sign} '{other.text}' in {other.unit}; only equal units can be added."
            )
        return self.unit


def _parenthesise(unit: str) -> str:
    if unit == ANY:
        return unit
    return unit if _SINGLE_UNIT.fullmatch(unit) else f"({unit})"
