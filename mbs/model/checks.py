"""Checks of what an engineer types: each returns clean numbers or raises one sentence."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mbs.elements.checks import not_negative, number, positive
from mbs.errors import ModelError

Vector = NDArray[np.float64]

__all__ = ["Vector", "direction", "inertia_matrix", "not_negative", "number", "perpendicular", "positive", "vector"]


def vector(value: ArrayLike, dimension: int, what: str) -> Vector:
    """`dimension` finite numbers, shape (dimension,)."""
    what = _capital(what)
    try:
        v = np.array(value, dtype=float)
    except (TypeError, ValueError):
        raise ModelError(f"{what} must be {dimension} numbers, not {value!r}.") from None
    if v.shape != (dimension,):
        raise ModelError(f"{what} has shape {v.shape}; it must be {dimension} numbers.")
    if not np.all(np.isfinite(v)):
        raise ModelError(f"{what} is {v.tolist()}; all numbers must be finite.")
    return v


def direction(value: ArrayLike, dimension: int, what: str) -> Vector:
    """A unit vector along `value`, shape (dimension,)."""
    v = vector(value, dimension, what)
    length = float(np.linalg.norm(v))
    if length == 0.0:
        raise ModelError(f"{_capital(what)} is zero; it must have a direction.")
    return v / length


def _capital(what: str) -> str:
    return what[:1].upper() + what[1:]


def perpendicular(axis: Vector) -> tuple[Vector, Vector]:
    """Unit vectors e1, e2 with e1 x e2 = axis; e1 along an earth axis where `axis` allows, so that equations stay
    short.
    """
    k = int(np.argmin(np.abs(axis)))
    e1 = -axis[k] * axis
    e1[k] += 1.0
    e1 = e1 / float(np.linalg.norm(e1))
    return e1, np.cross(axis, e1)


def inertia_matrix(value: Any, dimension: int, what: str) -> NDArray[np.float64]:
    """Inertia about the centre of mass as a 3x3 matrix (planar: zero but for zz), checked for physical possibility."""
    if dimension == 2:
        planar = np.zeros((3, 3))
        planar[2, 2] = positive(value, what)
        return planar
    try:
        inertia = np.array(value, dtype=float)
    except (TypeError, ValueError):
        raise ModelError(f"{what} must be 3 principal values or a 3x3 matrix, not {value!r}.") from None
    if inertia.shape == (3,):
        inertia = np.diag(inertia)
    if inertia.shape != (3, 3):
        raise ModelError(f"{what} has shape {inertia.shape}; give 3 principal values or a 3x3 matrix.")
    if not np.all(np.isfinite(inertia)):
        raise ModelError(f"{what} holds a number that is not finite.")
    if np.max(np.abs(inertia - inertia.T)) > 1e-9 * np.max(np.abs(inertia)):
        raise ModelError(f"{what} is not symmetric; the entry (i, j) must equal (j, i).")
    inertia = np.array(0.5 * (inertia + inertia.T))
    principal = np.linalg.eigvalsh(inertia)
    if principal[0] <= 0.0:
        raise ModelError(f"{what} has the principal value {principal[0]:g}; all must be greater than zero.")
    if principal[0] + principal[1] < principal[2] * (1.0 - 1e-9):
        raise ModelError(
            f"{what} has the principal values {principal[0]:g}, {principal[1]:g}, {principal[2]:g}; "
            "no mass distribution has one greater than the sum of the others."
        )
    return inertia
