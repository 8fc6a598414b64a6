"""Two unit vectors perpendicular to an axis."""

import numpy as np

from mbs.common.checks import Vector


def perpendicular(axis: Vector) -> tuple[Vector, Vector]:
    """Unit vectors e1, e2 with e1 x e2 = axis; e1 along an earth axis if `axis` allows it, for short equations."""
    k = int(np.argmin(np.abs(axis)))
    e1 = -axis[k] * axis
    e1[k] += 1.0
    e1 = e1 / float(np.linalg.norm(e1))
    return e1, np.cross(axis, e1)
