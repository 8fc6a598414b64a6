"""Triangles of simple solids, with normals; local coordinates, m."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_CREASE = math.cos(math.radians(35.0))  # edges of a profile that are sharper have two normals
_AXIS = 1e-9  # of the largest radius


@dataclass(frozen=True)
class Solid:
    """Triangles, counterclockwise as seen from outside."""

    positions: Array
    """m, shape (n, 3)."""
    normals: Array | None
    """Unit; None for flat triangles, shape (n, 3)."""
    triangles: NDArray[np.int64]
    """Numbers of positions, shape (m, 3)."""

    def placed(self, rotation: Array, at: Array | Sequence[float] = (0.0, 0.0, 0.0)) -> Solid:
        """The solid turned by a matrix, then moved."""
        normals = None if self.normals is None else self.normals @ rotation.T
        return Solid(self.positions @ rotation.T + np.asarray(at, dtype=float), normals, self.triangles)


def joined(solids: Sequence[Solid]) -> Solid:
    """Several solids, all with normals, as one."""
    starts = np.cumsum([0, *(len(s.positions) for s in solids[:-1])])
    return Solid(
        np.vstack([s.positions for s in solids]),
        np.vstack([s.normals for s in solids if s.normals is not None]),
        np.vstack([s.triangles + start for s, start in zip(solids, starts, strict=True)]),
    )


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


def cylinder(radius: float, low: float, high: float, sections: int = 32) -> Solid:
    """A cylinder about the y axis."""
    return lathe([(0.0, low), (radius, low), (radius, high), (0.0, high)], sections)


def sphere(radius: float, rings: int = 16) -> Solid:
    """A sphere about the origin."""
    angle = np.linspace(-0.5 * np.pi, 0.5 * np.pi, rings + 1)
    profile = radius * np.column_stack([np.cos(angle), np.sin(angle)])
    profile[[0, -1], 0] = 0.0
    return lathe(profile.tolist(), 2 * rings)


def torus(radius: float, thickness: float, sections: int = 48, sides: int = 12, arc: float | None = None) -> Solid:
    """A ring about the y axis; or an open arc of it about the z axis, of an angle in rad."""
    if arc is not None:
        turn = np.linspace(-0.5 * arc, 0.5 * arc, sections + 1)
        out = np.column_stack([np.sin(turn), np.zeros(len(turn)), np.cos(turn)])
        return swept(radius * out, out, np.tile([0.0, 1.0, 0.0], (len(turn), 1)), thickness, sides)
    angle = np.linspace(0.0, 2.0 * np.pi, sides + 1)
    profile = np.column_stack([radius + thickness * np.cos(angle), thickness * np.sin(angle)])
    profile[-1] = profile[0]
    return lathe(profile.tolist(), sections)


def coil(
    radius: float, wire: float, length: float, coils: float, dead: Sequence[float], sides: int, per_turn: int
) -> Solid:
    """A coil spring about the y axis, from y = 0 to `length`.

    Parameters
    ----------
    radius : float
        Of the middle of the wire, m.
    wire : float
        Its diameter, m.
    coils : float
        Turns.
    dead : (float, float)
        Turns at each end that lie flat: at most so many, and at most this share of all.
    sides, per_turn : int
        Points around the wire, and rings in a turn.
    """
    flat_turns, flat = min(dead[0], dead[1] * coils), min(wire, length / (coils + 1.0))
    active = coils - 2.0 * flat_turns
    rest = length - wire - 2.0 * flat_turns * flat
    turn = np.linspace(0.0, coils, round(coils * per_turn) + 1)
    ends = np.minimum(turn, flat_turns) + np.maximum(0.0, turn - (coils - flat_turns))
    y = 0.5 * wire + ends * flat + np.clip(turn - flat_turns, 0.0, active) / active * rest
    angle = 2.0 * np.pi * turn
    out = np.column_stack([np.sin(angle), np.zeros(len(turn)), np.cos(angle)])
    slope = np.full(len(turn), length / coils / (2.0 * np.pi))
    along = np.column_stack([radius * np.cos(angle), slope, -radius * np.sin(angle)])
    along /= np.linalg.norm(along, axis=1)[:, None]
    return swept(radius * out + np.column_stack([0 * y, y, 0 * y]), out, np.cross(out, along), 0.5 * wire, sides)


def swept(centres: Array, across: Array, other: Array, radius: float, sides: int = 8) -> Solid:
    """A round tube along a curve.

    `centres`: of its rings, shape (n, 3); `across`, `other`: unit vectors of the plane of each ring, shape (n, 3);
    their vector product points back along the curve.
    """
    turn = 2.0 * np.pi * np.arange(sides) / sides
    normals = across[:, None] * np.cos(turn)[:, None] + other[:, None] * np.sin(turn)[:, None]
    positions = centres[:, None] + radius * normals
    around, after = np.arange(sides), (np.arange(sides) + 1) % sides
    rows = []
    for i in range(len(centres) - 1):
        a, b = i * sides, (i + 1) * sides
        rows += [
            np.column_stack([a + around, b + around, a + after]),
            np.column_stack([a + after, b + around, b + after]),
        ]
    return Solid(positions.reshape(-1, 3), normals.reshape(-1, 3), np.vstack(rows))


def plate(points: Array, thickness: float) -> Solid:
    """A flat plate about the plane through the first three points; the others are put on it."""
    a = points[0]
    n = np.cross(points[1] - a, points[2] - a)
    n /= np.linalg.norm(n)
    flat = points - ((points - a) @ n)[:, None] * n
    k = len(flat)
    area = sum(float(np.cross(flat[i] - a, flat[i + 1] - a) @ n) for i in range(1, k - 1))
    if area < 0.0:
        n = -n
    sides = [np.array([flat[i], flat[(i + 1) % k]]) for i in range(k)]
    up = 0.5 * thickness * n
    fan = np.array([[0, i, i + 1] for i in range(1, k - 1)])
    made = [
        Solid(flat + up, np.tile(n, (k, 1)), fan),
        Solid(flat - up, np.tile(-n, (k, 1)), fan[:, ::-1]),
    ]
    for edge in sides:
        out = np.cross(edge[1] - edge[0], n)
        size = np.linalg.norm(out)
        if size > 0.0:
            corners = np.array([edge[0] - up, edge[1] - up, edge[1] + up, edge[0] + up])
            made.append(Solid(corners, np.tile(out / size, (4, 1)), np.array([[0, 1, 2], [0, 2, 3]])))
    return joined(made)


def along(direction: Array) -> Array:
    """A rotation matrix that takes y to a unit vector."""
    other = np.eye(3)[int(np.argmin(np.abs(direction)))]
    x = np.cross(direction, other)
    x /= np.linalg.norm(x)
    return np.column_stack([x, direction, np.cross(x, direction)])
