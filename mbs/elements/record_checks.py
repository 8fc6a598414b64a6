"""Checks of the data of elements; each function returns the value or raises `ModelError`.

`subject` begins the message.
"""

from collections.abc import Sequence

import numpy as np

from mbs.common.affine import AffineVector
from mbs.common.checks import capital, not_negative, number, positive, shown, whole
from mbs.common.errors import ModelError

INT32_MAX = 2**31 - 1
"""Largest number of the System file."""


def index(value: int, subject: str) -> int:
    """Return the index of an input or a road."""
    n = whole(value, subject, 0)
    if n > INT32_MAX:
        raise ModelError(f"{capital(subject)} is {shown(value)}; it must be a whole number, at most {INT32_MAX}.")
    return n


def share(value: object, subject: str) -> float:
    """Return a number above 0 and at most 1."""
    x = positive(value, subject)
    if x > 1.0:
        raise ModelError(f"{capital(subject)} is {shown(value)}; it must be above 0 and at most 1.")
    return x


def fraction(value: object, subject: str) -> float:
    """Return a number of at least 0 and below 1."""
    x = not_negative(value, subject)
    if x >= 1.0:
        raise ModelError(f"{capital(subject)} is {shown(value)}; it must be at least 0 and below 1.")
    return x


def check_components(vector: AffineVector, sizes: Sequence[int], subject: str) -> None:
    """Raise `ModelError` unless the number of components of a vector is one of `sizes`."""
    expected = " or ".join(str(n) for n in sizes)
    if not isinstance(vector, AffineVector):
        raise ModelError(
            f"{capital(subject)} must be a point or a vector of {expected} expressions, not {shown(vector)}."
        )
    if len(vector) not in sizes:
        raise ModelError(f"{capital(subject)} has {len(vector)} components; it must have {expected}.")


def number_list(values: Sequence[float], subject: str) -> list[float]:
    """Return a sequence of finite numbers as a list."""
    if not isinstance(values, (list, tuple, np.ndarray)) or np.ndim(np.asarray(values, dtype=object)) != 1:
        raise ModelError(f"{capital(subject)} must be a sequence of numbers, not {shown(values)}.")
    return [number(v, f"an entry of {subject}") for v in values]
