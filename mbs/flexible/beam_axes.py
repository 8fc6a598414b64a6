"""Local axes of a straight beam in space."""

import numpy as np

from mbs.common.vectors import cross

VERTICAL = 0.95  # beams steeper than this cosine take x instead of z as their upward direction


def beam_axes(start: np.ndarray, end: np.ndarray) -> tuple[float, np.ndarray]:
    """Length and axes of a beam: x from start to end, z as far up as it can be, y = z cross x to the left.

    `start`, `end`: ends, m, shape (3,). A beam that stands upright has local z along the global x as far as it can.

    Returns
    -------
    length : float
        m.
    R : ndarray, shape (3, 3)
        Rows are the local axes in body axes: ``local = R @ global``.
    """
    along = end - start
    length = float(np.linalg.norm(along))
    ex = along / length
    up = np.array([0.0, 0.0, 1.0]) if abs(ex[2]) < VERTICAL else np.array([1.0, 0.0, 0.0])
    ey = cross(up, ex)
    ey /= np.linalg.norm(ey)
    return length, np.array([ex, ey, cross(ex, ey)])
