"""Checks of the data of an element other than numbers: each returns a clean value or raises one sentence."""

from collections.abc import Sequence

import numpy as np

from mbs.common.affine import AffineVector
from mbs.common.checks import capital, not_negative, number, positive, shown, whole
from mbs.common.errors import ModelError

MOST = 2**31 - 1
"""Largest number of the System file."""


def index(value: int, what: str) -> int:
    """Number of an input or a road."""
    n = whole(value, what, 0)
    if n > MOST:
        raise ModelError(f"{capital(what)} is {shown(value)}; it must be a whole number, at most {MOST}.")
    return n


def share(value: object, what: str) -> float:
    """A number above zero, at most one."""
    x = positive(value, what)
    if x > 1.0:
        raise ModelError(f"{capital(what)} is {shown(value)}; it must be above 0 and at most 1.")
    return x


def fraction(value: object, what: str) -> float:
    """A number from zero on, below one."""
    x = not_negative(value, what)
    if x >= 1.0:
        raise ModelError(f"{capital(what)} is {shown(value)}; it must be at least 0 and below 1.")
    return x


def size(vector: AffineVector, sizes: Sequence[int], what: str) -> None:
    """The number of components of an expression."""
    expected = " or ".join(str(n) for n in sizes)
    if not isinstance(vector, AffineVector):
        raise ModelError(f"{capital(what)} must be a point or a vector of {expected} expressions, not {shown(vector)}.")
    if len(vector) not in sizes:
        raise ModelError(f"{capital(what)} has {len(vector)} components; it must have {expected}.")


def several(values: Sequence[float], what: str) -> list[float]:
    """Finite numbers, one at least."""
    if not isinstance(values, (list, tuple, np.ndarray)) or np.ndim(np.asarray(values, dtype=object)) != 1:
        raise ModelError(f"{capital(what)} must be a sequence of numbers, not {shown(values)}.")
    return [number(v, f"an entry of {what}") for v in values]
