"""Checks of the data of an element beside those of numbers: each returns a clean value or raises one sentence."""

from __future__ import annotations

from collections.abc import Sequence

from mbs.affine import AffineVector
from mbs.checks import capital, shown, whole
from mbs.errors import ModelError


def index(value: int, what: str) -> int:
    """Number of an input or a road."""
    return whole(value, what, 0)


def size(vector: AffineVector, sizes: Sequence[int], what: str) -> None:
    """The number of components of an expression."""
    wanted = " or ".join(str(n) for n in sizes)
    if not isinstance(vector, AffineVector):
        raise ModelError(f"{capital(what)} must be a point or a vector of {wanted} expressions, not {shown(vector)}.")
    if len(vector) not in sizes:
        raise ModelError(f"{capital(what)} has {len(vector)} components; it must have {wanted}.")
