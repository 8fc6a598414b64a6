"""Kerbs, ramps and washboards: additions to the height of the ground, in frames of their own."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mbs.worlds.profiles import rise, table, vertical_curve
from mbs.worlds.world_types import Band, Kerb, Ramp, Washboard

Float = NDArray[np.float64]


@dataclass(frozen=True)
class Footprint:
    """A rectangle on the ground: from u = 0 to its length ahead, from `right` to `left` across."""

    x: float
    y: float
    yaw: float
    """`x`, `y`, `yaw`: of its frame, m and rad."""
    length: float
    right: float
    left: float
    """`length`, `right`, `left`: m."""

    def local(self, x: Float, y: Float) -> tuple[Float, Float]:
        """Places in its frame."""
        c, s = _turn(self.yaw)
        dx, dy = x - self.x, y - self.y
        return c * dx + s * dy, c * dy - s * dx

    def corners(self) -> Float:
        """Corners in earth axes, shape (4, 2), m."""
        c, s = _turn(self.yaw)
        ends = [(0.0, self.right), (self.length, self.right), (self.length, self.left), (0.0, self.left)]
        return np.array([(self.x + c * u - s * v, self.y + s * u + c * v) for u, v in ends])

    def box(self) -> tuple[float, float, float, float]:
        """Smallest and largest x and y: x0, y0, x1, y1."""
        corners = self.corners()
        (x0, y0), (x1, y1) = corners.min(axis=0), corners.max(axis=0)
        return float(x0), float(y0), float(x1), float(y1)

    def inside(self, x: Float, y: Float) -> NDArray[np.bool_]:
        """Whether places lie on it."""
        u, v = self.local(x, y)
        return np.asarray((u >= 0.0) & (u <= self.length) & (v >= self.right) & (v <= self.left))


def _turn(yaw: float) -> tuple[float, float]:
    """Cosine and sine, exact at right angles."""
    quarter = yaw / (0.5 * math.pi)
    if abs(quarter - round(quarter)) < 1e-12:
        return ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[round(quarter) % 4]
    return math.cos(yaw), math.sin(yaw)


def footprint(part: Kerb | Ramp | Washboard | Band) -> Footprint:
    """Rectangle on the ground of an obstacle or a band."""
    x, y, yaw = part.at
    if isinstance(part, (Kerb, Band)):
        return Footprint(x, y, math.radians(yaw), part.length, part.right, part.left)
    length = ramp_length(part) if isinstance(part, Ramp) else part.length
    return Footprint(x, y, math.radians(yaw), length, -0.5 * part.width, 0.5 * part.width)


def _ramp_lines(ramp: Ramp) -> list[tuple[float, float]]:
    """Vertices of the lines of a ramp: the upper one is so high that the rounded top has the ramp's height."""
    first, top, _ = ramp.roundings
    vertex = ramp.height + 0.5 * top * ramp.grade * ramp.drop / (ramp.grade + ramp.drop)
    begin = 0.5 * first
    up = vertex / ramp.grade
    return [(begin, 0.0), (begin + up, vertex), (begin + up + vertex / ramp.drop, 0.0)]


def ramp_length(ramp: Ramp) -> float:
    """Length of a ramp, m."""
    return _ramp_lines(ramp)[-1][0] + 0.5 * ramp.roundings[2]


def added(part: Kerb | Ramp | Washboard, x: Float, y: Float) -> Float:
    """Heights that an obstacle adds at places, m."""
    base = footprint(part)
    u, v = base.local(x, y)
    across = table(v - base.right, base.left - base.right, part.flank)
    if isinstance(part, Kerb):
        return part.height * table(u, base.length, part.face) * across
    if isinstance(part, Ramp):
        return np.asarray(vertical_curve(u, _ramp_lines(part), part.roundings) * across)
    envelope = np.clip(u / part.wavelength, 0.0, 1.0) * np.clip((base.length - u) / part.wavelength, 0.0, 1.0)
    waves = 0.5 * part.height * np.sin(2.0 * np.pi * u / part.wavelength)
    return np.asarray(waves * rise(envelope) * across)
