"""Mass, centre of mass and inertia of links fixed to each other, and the correction of impossible inertias."""

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mbs.common.checks import array
from mbs.common.errors import ModelError
from mbs.model.inertia import inertia_matrix

Array = NDArray[np.float64]

MAX_CORRECTION = 0.05
"""Largest correction of an inertia, relative to its largest principal value."""
MIN_SECOND_MOMENT = 1e-6
"""Least second moment of mass of a corrected inertia, relative to the largest: a rod has a thickness."""


class UrdfWarning(UserWarning):
    """The model differs from what a URDF file describes."""


def origin_pose(origin: Any) -> Array:
    """Homogeneous transformation of an element's origin, shape (4, 4), m; the identity if it has none."""
    return np.eye(4) if origin is None else np.asarray(origin, float)


def combined_mass(parts: Iterable[tuple[Any, Array]]) -> tuple[float, Array, Array]:
    """Mass, kg, centre of mass (3,), m, and inertia about it (3, 3), kg m2, of several links together, in earth axes.

    A link may have an inertia without a mass, as a rotor; if the sum of the masses is 0, the centre is the origin.

    `parts`: links with their frames, (4, 4), in earth axes. Raises `ModelError` if a link with a mass has no inertia.
    """
    masses = []
    for link, pose in parts:
        inertial = link.inertial
        if inertial is None or not (inertial.mass or (inertial.inertia is not None and np.any(inertial.inertia))):
            continue
        frame = pose @ origin_pose(inertial.origin)
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


def corrected_inertia(inertia: Array, subject: str) -> tuple[Array, str]:
    """Correct an inertia (3, 3), kg m2, that no mass distribution has; return it with a sentence, otherwise empty.

    The correction makes the second moments of mass, tr(I)/2 - I, positive.

    `subject`: file and link, for messages. Raises `ModelError` if the correction is larger than `MAX_CORRECTION`.
    """
    try:
        return inertia_matrix(inertia, 3, subject), ""
    except ModelError as error:
        symmetric = 0.5 * (inertia + inertia.T)
        eigenvalues, axes = np.linalg.eigh(symmetric)
        moments = 0.5 * np.sum(eigenvalues) - eigenvalues
        if not np.max(moments) > 0.0 or np.max(np.abs(inertia - symmetric)) > MAX_CORRECTION * eigenvalues[-1]:
            raise
        moments = np.maximum(moments, MIN_SECOND_MOMENT * np.max(moments))
        corrected = np.sum(moments) - moments
        change = float(np.max(np.abs(corrected - eigenvalues))) / eigenvalues[-1]
        values, corrected_values = (", ".join(f"{v:.6g}" for v in principal) for principal in (eigenvalues, corrected))
        fault = f"{subject} has the principal values {values} kg m2, which no mass distribution can have"
        if change > MAX_CORRECTION:
            raise ModelError(
                f"{fault}; the nearest possible ones are {corrected_values}, {100.0 * change:.2g} % of the largest "
                f"away. Correct the file, for example to those; up to {100.0 * MAX_CORRECTION:g} % are corrected "
                "here with a warning."
            ) from error
        note = f"{fault}; {corrected_values} are used instead, {100.0 * change:.2g} % of the largest away."
        return np.asarray((axes * corrected) @ axes.T), note
