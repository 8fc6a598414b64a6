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
    """A URDF file says what the model has not."""


def pose_of(origin: Any) -> Array:
    """Frame of an element, shape (4, 4), m."""
    return np.eye(4) if origin is None else np.asarray(origin, float)


def mass_of(parts: Iterable[tuple[Any, Array]]) -> tuple[float, Array, Array]:
    """Mass, centre and inertia about it of several links together, earth axes; a rotor may have an inertia alone.

    Without a mass of all together the centre is at the origin, and the inertia is the sum.

    `parts`: links with their frames in earth axes. Raises `ModelError`: a link with a mass has no inertia.
    """
    found = []
    for link, pose in parts:
        given = link.inertial
        if given is None or not (given.mass or (given.inertia is not None and np.any(given.inertia))):
            continue
        own = pose @ pose_of(given.origin)
        inertia = array(given.inertia, (3, 3), f"the inertia of the link '{link.name}'")
        found.append((float(given.mass or 0.0), own[:3, 3], own[:3, :3] @ inertia @ own[:3, :3].T))
    mass = sum(m for m, _, _ in found)
    if mass <= 0.0:
        return mass, np.zeros(3), sum((tensor for _, _, tensor in found), np.zeros((3, 3)))
    com = sum((m * c for m, c, _ in found), np.zeros(3)) / mass
    inertia = np.zeros((3, 3))
    for m, c, tensor in found:
        arm = c - com
        inertia += tensor + m * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    return mass, com, inertia


def possible_inertia(inertia: Array, what: str) -> tuple[Array, str]:
    """The inertia, shape (3, 3), or next to it one that a mass distribution has, and by how much it was changed.

    `what`: file and link, for messages. Its second moments of mass, tr(I)/2 - I, are made positive.

    Raises
    ------
    ModelError
        The correction is larger than `SLIGHT`.
    """
    try:
        return inertia_matrix(inertia, 3, what), ""
    except ModelError as error:
        symmetric = 0.5 * (inertia + inertia.T)
        given, axes = np.linalg.eigh(symmetric)
        moments = 0.5 * np.sum(given) - given
        if not np.max(moments) > 0.0 or np.max(np.abs(inertia - symmetric)) > SLIGHT * given[-1]:
            raise
        moments = np.maximum(moments, THIN * np.max(moments))
        near = np.sum(moments) - moments
        change = float(np.max(np.abs(near - given))) / given[-1]
        values, nearest = (", ".join(f"{v:.6g}" for v in principal) for principal in (given, near))
        says = (
            f"{what} has the principal values {values} kg m2, which no mass distribution has; the nearest that one has"
        )
        if change > SLIGHT:
            raise ModelError(
                f"{says} are {nearest}, {100.0 * change:.2g} % of the largest away. Correct the file, for example to "
                f"those; up to {100.0 * SLIGHT:g} % are corrected here with a warning."
            ) from error
        warning = f"{says}, {nearest}, are taken: {100.0 * change:.2g} % of the largest away."
        return np.asarray((axes * near) @ axes.T), warning
