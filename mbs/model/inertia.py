"""Inertia of a body from principal values or a matrix, checked."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mbs.common.checks import array, capital, is_number, positive
from mbs.common.errors import ModelError

ROUND_OFF = 1e-14
"""Part of the largest principal value below which the smallest of a sum of point masses is round-off."""


def inertia_matrix(value: ArrayLike, dimension: int, subject: str) -> NDArray[np.float64]:
    """Inertia about the centre of mass as a 3x3 matrix (planar: zero but for zz), checked for physical possibility."""
    if dimension == 2:
        planar = np.zeros((3, 3))
        planar[2, 2] = positive(value, subject)
        return planar
    expected = "3 principal values or a 3x3 matrix"
    is_matrix = (
        isinstance(value, (Sequence, np.ndarray)) and len(value) == 3 and not any(is_number(row) for row in value)
    )
    inertia = array(value, (3, 3) if is_matrix else (3,), subject, wanted=expected)
    if inertia.shape == (3,):
        inertia = np.diag(inertia)
    if np.max(np.abs(inertia - inertia.T)) > 1e-9 * np.max(np.abs(inertia)):
        raise ModelError(f"{capital(subject)} is not symmetric; the entry (i, j) must equal (j, i).")
    inertia = np.array(0.5 * (inertia + inertia.T))
    principal = np.linalg.eigvalsh(inertia)
    if principal[0] <= ROUND_OFF * abs(principal[2]):
        raise ModelError(
            f"{capital(subject)} has the principal value {principal[0]:g}, beside {principal[2]:g}; all must be "
            "greater than zero, and than its round-off."
        )
    if principal[0] + principal[1] < principal[2] * (1.0 - 1e-9):
        raise ModelError(
            f"{capital(subject)} has the principal values {principal[0]:g}, {principal[1]:g}, {principal[2]:g}; "
            "no mass distribution has one greater than the sum of the others."
        )
    return inertia
