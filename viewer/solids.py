"""Triangles of simple solids, with normals; local coordinates, m."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from viewer.gltf.solids import Solid

Array = NDArray[np.float64]

_CREASE = math.cos(math.radians(35.0))  # edges of a profile that are sharper have two normals
_AXIS = 1e-9  # of the largest radius


def placed(solid: Solid, rotation: Array, at: Array | Sequence[float] = (0.0, 0.0, 0.0)) -> Solid:
    """The solid turned by a matrix, then moved."""
    normals = None if solid.normals is None else solid.normals @ rotation.T
    return Solid(solid.positions @ rotation.T + np.asarray(at, dtype=float), normals, solid.triangles)


def box(size: Sequence[float]) -> Solid:
    """A box about the origin."""
    half = 0.5 * np.asarray(size, dtype=float)
    positions: list[Array] = []
    normals: list[Array] = []
    triangles: list[list[int]] = []
    for axis in range(3):
        for sign in (1.0, -1.0):
            u, v = np.eye(3)[(axis + 1) % 3], np.eye(3)[(axis + 2) % 3] * sign
            n = np.eye(3)[axis] * sign
            start = len(positions)
            positions += [(n + a * u + b * v) * half for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
            normals += [n] * 4
            triangles += [[start, start + 1, start + 2], [start, start + 2, start + 3]]
    return Solid(np.array(positions), np.array(normals), np.array(triangles))


def lathe(profile: Sequence[Sequence[float]], sections: int = 32) -> Solid:
    """A profile turned about the y axis.

    Parameters
    ----------
    profile : sequence of (radius, y)
        With the solid on its left: outside it runs along +y. A profile whose ends are the same point is a ring.
    sections : int
        Of a full turn.
    """
    p = np.asarray(profile, dtype=float)
    step = np.diff(p, axis=0)
    flat = np.column_stack([step[:, 1], -step[:, 0]]) / np.linalg.norm(step, axis=1)[:, None]
    closed = bool(np.allclose(p[0], p[-1], rtol=0.0, atol=_AXIS))
    turn = 2.0 * np.pi * np.arange(sections) / sections
    around = np.arange(sections)
    after = (around + 1) % sections
    small = _AXIS * p[:, 0].max()
    positions, normals, triangles = [], [], []
    for i in range(len(step)):
        for end in (0, 1):
            r, y = p[i + end]
            n = _smooth(flat, i, i + 2 * end - 1, closed)
            positions.append(np.column_stack([r * np.sin(turn), np.full(sections, y), r * np.cos(turn)]))
            normals.append(np.column_stack([n[0] * np.sin(turn), np.full(sections, n[1]), n[0] * np.cos(turn)]))
        a, b = (2 * i) * sections, (2 * i + 1) * sections
        if p[i, 0] > small:
            triangles.append(np.column_stack([a + around, a + after, b + around]))
        if p[i + 1, 0] > small:
            triangles.append(np.column_stack([a + after, b + after, b + around]))
    return Solid(np.vstack(positions), np.vstack(normals), np.vstack(triangles))


def _smooth(flat: Array, segment: int, beside: int, closed: bool) -> Array:
    """Normal of a segment at the end towards the one beside it."""
    own = flat[segment]
    if not closed and not 0 <= beside < len(flat):
        return np.asarray(own)
    other = flat[beside % len(flat)]
    if float(own @ other) < _CREASE:
        return np.asarray(own)
    return np.asarray((own + other) / np.linalg.norm(own + other))
