"""Mass, centre and inertia of links that are fixed to each other, corrected where no mass distribution has them."""

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mbs.common.checks import array
from mbs.common.errors import ModelError
from mbs.model.inertia import inertia_matrix

Array = NDArray[np.float64]

SLIGHT = 0.05
"""Largest correction of an inertia, part of its largest principal value."""
THIN = 1e-6
"""Smallest second moment of mass of a corrected inertia, part of the largest: a rod has a thickness."""


class UrdfWarning(UserWarning):
    """The model differs from what a URDF file describes."""


def pose_of(origin: Any) -> Array:
    """Homogeneous transformation of an element's origin, shape (4, 4), m; the identity if it has none."""
    return np.eye(4) if origin is None else np.asarray(origin, float)


def mass_of(parts: Iterable[tuple[Any, Array]]) -> tuple[float, Array, Array]:
    """Mass (kg), centre of mass (3,) (m) and inertia (3, 3) about it (kg m2) of several links together, in earth axes.

    A rotor may have an inertia without a mass; if the sum of all masses is zero, the centre is the origin.

    `parts`: links with their frames, (4, 4), in earth axes. Raises `ModelError`: a link with a mass has no inertia.
    """
    masses = []
    for link, pose in parts:
        inertial = link.inertial
        if inertial is None or not (inertial.mass or (inertial.inertia is not None and np.any(inertial.inertia))):
            continue
        frame = pose @ pose_of(inertial.origin)
        inertia = array(inertial.inertia, (3, 3), f"the inertia of the link '{link.name}'")
        masses.append((float(inertial.mass or 0.0), frame[:3, 3], frame[:3, :3] @ inertia @ frame[:3, :3].T))
    mass = sum(m for m, _, _ in masses)
    if mass <= 0.0:
        return mass, np.zeros(3), sum((tensor for _, _, tensor in masses), np.zeros((3, 3)))
    com = sum((m * c for m, c, _ in masses), np.zeros(3)) / mass
    inertia = np.zeros((3, 3))
    for m, c, tensor in masses:
        arm = c - com
        inertia += tensor + m * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    return mass, com, inertia


def possible_inertia(inertia: Array, what: str) -> tuple[Array, str]:
    """An inertia (3, 3), kg m2, corrected if no mass distribution can have it, and a sentence on the correction.

    The correction makes the second moments of mass, tr(I)/2 - I, positive; the sentence is empty if there is none.

    `what`: file and link, for messages. Raises `ModelError`: the correction is larger than `SLIGHT`.
    """
    try:
        return inertia_matrix(inertia, 3, what), ""
    except ModelError as error:
        symmetric = 0.5 * (inertia + inertia.T)
        eigenvalues, axes = np.linalg.eigh(symmetric)
        moments = 0.5 * np.sum(eigenvalues) - eigenvalues
        if not np.max(moments) > 0.0 or np.max(np.abs(inertia - symmetric)) > SLIGHT * eigenvalues[-1]:
            raise
        moments = np.maximum(moments, THIN * np.max(moments))
        corrected = np.sum(moments) - moments
        change = float(np.max(np.abs(corrected - eigenvalues))) / eigenvalues[-1]
        values, nearest = (", ".join(f"{v:.6g}" for v in principal) for principal in (eigenvalues, corrected))
        fault = f"{what} has the principal values {values} kg m2, which no mass distribution can have"
        if change > SLIGHT:
            raise ModelError(
                f"{fault}; the nearest possible ones are {nearest}, {100.0 * change:.2g} % of the largest away. "
                f"Correct the file, for example to those; up to {100.0 * SLIGHT:g} % are corrected here with a warning."
            ) from error
        note = f"{fault}; {nearest} are used instead, {100.0 * change:.2g} % of the largest away."
        return np.asarray((axes * corrected) @ axes.T), note
