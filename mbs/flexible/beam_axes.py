"""Local axes of a straight beam in space."""

import numpy as np

from mbs.common.vectors import cross

VERTICAL = 0.95  # cosine from the vertical above which x replaces z as the upward direction


def beam_axes(start: np.ndarray, end: np.ndarray) -> tuple[float, np.ndarray]:
    """Length and axes of a beam: x from start to end, z as near to the vertical as possible, y = z cross x.

    `start`, `end`: ends, m, shape (3,). A vertical beam has z as near to the global x as possible.

    Returns
    -------
    length : float
        m.
    R : ndarray, shape (3, 3)
        Rows are the local axes in body axes: ``local = R @ global``.
    """
    difference = end - start
    length = float(np.linalg.norm(difference))
    ex = difference / length
    up = np.array([0.0, 0.0, 1.0]) if abs(ex[2]) < VERTICAL else np.array([1.0, 0.0, 0.0])
    ey = cross(up, ex)
    ey /= np.linalg.norm(ey)
    return length, np.array([ex, ey, cross(ex, ey)])
