"""Kerbs, ramps and washboards: heights that are added to the ground, in frames of their own."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mbs.worlds.profiles import plateau, rise, vertical_curve
from mbs.worlds.world_types import Band, Kerb, Ramp, Washboard

Float = NDArray[np.float64]


@dataclass(frozen=True)
class Footprint:
    """A rectangle on the ground: u from 0 to `length` along its frame, v from `right` to `left` across."""

    x: float
    """x of the origin of its frame, m."""
    y: float
    """y of the origin of its frame, m."""
    yaw: float
    """Yaw of its frame, rad."""
    length: float
    """Length along the x axis of its frame, m."""
    right: float
    """y of the right edge in its frame, m."""
    left: float
    """y of the left edge in its frame, m."""

    def local(self, x: Float, y: Float) -> tuple[Float, Float]:
        """Coordinates u, v of points in its frame, m."""
        c, s = _cos_sin(self.yaw)
        dx, dy = x - self.x, y - self.y
        return c * dx + s * dy, c * dy - s * dx

    def corners(self) -> Float:
        """Corners in earth axes, shape (4, 2), m."""
        c, s = _cos_sin(self.yaw)
        ends = [(0.0, self.right), (self.length, self.right), (self.length, self.left), (0.0, self.left)]
        return np.array([(self.x + c * u - s * v, self.y + s * u + c * v) for u, v in ends])

    def box(self) -> tuple[float, float, float, float]:
        """Bounding box: x0, y0, x1, y1, m."""
        corners = self.corners()
        (x0, y0), (x1, y1) = corners.min(axis=0), corners.max(axis=0)
        return float(x0), float(y0), float(x1), float(y1)

    def inside(self, x: Float, y: Float) -> NDArray[np.bool_]:
        """Whether points lie on it."""
        u, v = self.local(x, y)
        return np.asarray((u >= 0.0) & (u <= self.length) & (v >= self.right) & (v <= self.left))


def _cos_sin(yaw: float) -> tuple[float, float]:
    """Cosine and sine of an angle, rad, exact at multiples of a right angle."""
    quarter = yaw / (0.5 * math.pi)
    if abs(quarter - round(quarter)) < 1e-12:
        return ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[round(quarter) % 4]
    return math.cos(yaw), math.sin(yaw)


def footprint(feature: Kerb | Ramp | Washboard | Band) -> Footprint:
    """Rectangle on the ground of an obstacle or a band."""
    x, y, yaw = feature.at
    if isinstance(feature, (Kerb, Band)):
        return Footprint(x, y, math.radians(yaw), feature.length, feature.right, feature.left)
    length = ramp_length(feature) if isinstance(feature, Ramp) else feature.length
    return Footprint(x, y, math.radians(yaw), length, -0.5 * feature.width, 0.5 * feature.width)


def _ramp_lines(ramp: Ramp) -> list[tuple[float, float]]:
    """Vertices of the profile of a ramp, m; the upper one is so high that the rounded top has the ramp's height."""
    first, top, _ = ramp.roundings
    vertex = ramp.height + 0.5 * top * ramp.grade * ramp.drop / (ramp.grade + ramp.drop)
    begin = 0.5 * first
    up = vertex / ramp.grade
    return [(begin, 0.0), (begin + up, vertex), (begin + up + vertex / ramp.drop, 0.0)]


def ramp_length(ramp: Ramp) -> float:
    """Length of a ramp, m."""
    return _ramp_lines(ramp)[-1][0] + 0.5 * ramp.roundings[2]


def added_height(obstacle: Kerb | Ramp | Washboard, x: Float, y: Float) -> Float:
    """Heights that an obstacle adds at points, m."""
    base = footprint(obstacle)
    u, v = base.local(x, y)
    across = plateau(v - base.right, base.left - base.right, obstacle.flank)
    if isinstance(obstacle, Kerb):
        return obstacle.height * plateau(u, base.length, obstacle.face) * across
    if isinstance(obstacle, Ramp):
        return np.asarray(vertical_curve(u, _ramp_lines(obstacle), obstacle.roundings) * across)
    envelope = np.clip(u / obstacle.wavelength, 0.0, 1.0) * np.clip((base.length - u) / obstacle.wavelength, 0.0, 1.0)
    waves = 0.5 * obstacle.height * np.sin(2.0 * np.pi * u / obstacle.wavelength)
    return np.asarray(waves * rise(envelope) * across)
