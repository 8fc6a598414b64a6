"""Surfaces through cross-sections."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

Positions = NDArray[np.float64]
Triangles = NDArray[np.int64]


def loft(sections: Sequence[Positions], *, ends: bool = False) -> tuple[Positions, Triangles]:
    """Mesh of both sides of a surface through the left halves of cross-sections.

    `sections`: each from its lower outer edge to the plane of symmetry, y = 0; from the rear to the front,
    shape (n, 3); `ends`: whether the first and the last section are closed by a flat cap.

    Returns
    -------
    positions, triangles : array of shape (m, 3), array of shape (k, 3)
        The triangles are seen from outside counter-clockwise.
    """
    halves = [np.asarray(section, float) for section in sections]
    outlines = [np.vstack([section, section[-2::-1] * [1.0, -1.0, 1.0]]) for section in halves]
    n = len(outlines[0])
    positions = [np.vstack(outlines)]
    triangles = [
        t
        for k in range(len(outlines) - 1)
        for i in range(n - 1)
        for a in [k * n + i]
        for t in ((a, a + n + 1, a + n), (a, a + 1, a + n + 1))
    ]
    if ends:
        for section, flip in ((outlines[0], False), (outlines[-1], True)):
            first = sum(map(len, positions))
            positions += [section, section.mean(axis=0, keepdims=True)]
            middle = first + n
            ring = [(first + i, first + (i + 1) % n) for i in range(n)]
            triangles += [(middle, a, b) if flip else (middle, b, a) for a, b in ring]
    return np.vstack(positions), np.array(triangles)


def interpolate_columns(table: NDArray[np.float64], at: NDArray[np.float64]) -> NDArray[np.float64]:
    """The other columns of a table at values of its first one, by cubics without overshoot, shape (n, columns - 1).

    `table`: rows, ascending in the first column; `at`: values of the first column, shape (n,).
    """
    return np.asarray(PchipInterpolator(table[:, 0], table[:, 1:], axis=0)(np.clip(at, table[0, 0], table[-1, 0])))
