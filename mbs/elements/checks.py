"""Checks of the data of an element: each returns a clean number or raises one sentence."""

from __future__ import annotations

import math
from collections.abc import Sequence

from mbs.affine import AffineVector
from mbs.errors import ModelError


def number(value: float, what: str) -> float:
    """A finite number."""
    try:
        x = float(value)
    except (TypeError, ValueError):
        raise ModelError(f"{what} must be a number, not {value!r}.") from None
    if not math.isfinite(x):
        raise ModelError(f"{what} is {x}; it must be a finite number.")
    return x


def positive(value: float, what: str) -> float:
    """A finite number above zero."""
    x = number(value, what)
    if x <= 0.0:
        raise ModelError(f"{what} is {x:g}; it must be greater than zero.")
    return x


def not_negative(value: float, what: str) -> float:
    """A finite number, zero or above."""
    x = number(value, what)
    if x < 0.0:
        raise ModelError(f"{what} is {x:g}; it must not be negative.")
    return x


def index(value: int, what: str) -> int:
    """Number of an input or a road."""
    if isinstance(value, bool) or int(value) != value or value < 0:
        raise ModelError(f"{what} is {value!r}; it must be a whole number, zero or above.")
    return int(value)


def size(vector: AffineVector, sizes: Sequence[int], what: str) -> None:
    """The number of components of an expression."""
    if len(vector) not in sizes:
        raise ModelError(f"{what} has {len(vector)} components; it must have {' or '.join(str(n) for n in sizes)}.")
