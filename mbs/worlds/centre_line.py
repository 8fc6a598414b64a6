"""Centre line of a course: a spline through points or segments, its stations and its lateral offsets."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from mbs.roads.road_header import RoadFileError
from mbs.worlds.world_types import Segment

Float = NDArray[np.float64]
STEP = 1.0
"""Approximate distance of the points of the spline, m."""
ITERATIONS = 3
"""Number of iterations of Newton's method for the nearest station."""
MIN_SLOPE = 0.3
"""Lower bound of its derivative, which is 0 at the centre of curvature."""
MAX_CORRECTION = 5.0
"""Upper bound of its correction for distant points, m."""
MAX_GAP = 0.05
"""Largest distance between the ends of a closed course, m."""


@dataclass(frozen=True)
class CentreLine:
    """A cubic spline through points at equal distances, m."""

    step: float
    """Distance of the points along the line, m."""
    points: Float
    """Shape (n, 2), m; the last point of a closed line is its first."""
    coefficients: Float
    """Shape (2, 4, n - 1): coefficients of x and y in powers of the distance along the line from each point."""
    closed: bool
    straight: bool

    @property
    def length(self) -> float:
        """Length along the line, m."""
        return self.step * (len(self.points) - 1)

    @property
    def stations(self) -> Float:
        """Stations of the points, m."""
        return np.asarray(self.step * np.arange(len(self.points)))

    def at(self, s: Float) -> tuple[Float, Float, Float]:
        """Position, m, and its first two derivatives with respect to the station s, m, each of shape (2, ...)."""
        k = np.clip((s / self.step).astype(np.int64), 0, len(self.points) - 2)
        t = s - k * self.step
        c = self.coefficients[:, :, k]
        position = ((c[:, 3] * t + c[:, 2]) * t + c[:, 1]) * t + c[:, 0]
        first = (3.0 * c[:, 3] * t + 2.0 * c[:, 2]) * t + c[:, 1]
        return position, first, 6.0 * c[:, 3] * t + 2.0 * c[:, 2]

    def beside(self, x: Float, y: Float, guess: Float) -> tuple[Float, Float, Float]:
        """Nearest station, offset to the left and distance of points, m; `guess`: approximate station, m."""
        if self.straight:
            chord = self.points[-1] - self.points[0]
            unit = chord / np.hypot(*chord)
            dx, dy = x - self.points[0, 0], y - self.points[0, 1]
            along = dx * unit[0] + dy * unit[1]
            s, offset = np.clip(along, 0.0, self.length), unit[0] * dy - unit[1] * dx
            return s, offset, np.hypot(offset, along - s)
        s = guess
        for _ in range(ITERATIONS):
            p, tangent, tangent_rate = self.at(s)
            difference = p - np.stack([x, y])
            slope = np.maximum((tangent * tangent).sum(axis=0) + (difference * tangent_rate).sum(axis=0), MIN_SLOPE)
            s = self._within(s - np.clip((difference * tangent).sum(axis=0) / slope, -MAX_CORRECTION, MAX_CORRECTION))
        p, tangent, _ = self.at(s)
        dx, dy = x - p[0], y - p[1]
        norm = np.hypot(tangent[0], tangent[1])
        return s, (tangent[0] * dy - tangent[1] * dx) / norm, np.hypot(dx, dy)

    def _within(self, s: Float) -> Float:
        """Stations on the line: periodic on a closed line, otherwise clipped."""
        return np.asarray(np.mod(s, self.length) if self.closed else np.clip(s, 0.0, self.length))

    def pose(self, s: float, offset: float = 0.0) -> tuple[float, float, float]:
        """Position x, y, m, and yaw, rad, at a station and an offset to the left, m."""
        p, tangent, _ = self.at(np.array(self._within(np.array(s))))
        norm = math.hypot(tangent[0], tangent[1])
        return (
            float(p[0] - offset * tangent[1] / norm),
            float(p[1] + offset * tangent[0] / norm),
            math.atan2(tangent[1], tangent[0]),
        )


def curve_through(points: Float, closed: bool, name: str) -> tuple[CubicSpline, Float]:
    """Spline through two or more points, and their parameters on it; a closed one repeats the first point at its end.

    `name`: name of the course, for messages. Raises `RoadFileError` if points coincide.
    """
    if closed and np.hypot(*(points[0] - points[-1])) > 1e-9:
        points = np.vstack([points, points[:1]])
    lengths = np.hypot(*np.diff(points, axis=0).T)
    if (lengths <= 1e-6).any():
        k = int(np.argmin(lengths))
        raise RoadFileError(f"Points {k + 1} and {k + 2} of the course '{name}' are the same; leave one out.")
    u = np.concatenate([[0.0], np.cumsum(lengths)])
    return CubicSpline(u, points, bc_type="periodic" if closed else "natural"), u


def line_through(points: Float, closed: bool, name: str) -> CentreLine:
    """Line through two or more points (n, 2), m. Raises `RoadFileError` if points coincide."""
    curve, u = curve_through(points, closed, name)
    if len(u) == 2:
        return _line_through_equidistant(points, closed)
    parameters = np.linspace(0.0, u[-1], max(20 * len(u), int(u[-1] / 0.05)))
    samples = curve(parameters)
    s = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(samples, axis=0).T))])
    n = max(4, math.ceil(s[-1] / STEP))
    return _line_through_equidistant(curve(np.interp(np.linspace(0.0, s[-1], n + 1), s, parameters)), closed, s[-1])


def line_of_segments(
    start: tuple[float, float, float], segments: Sequence[Segment], closed: bool, name: str
) -> CentreLine:
    """Line of straights and arcs.

    `start`: x, y, m, and yaw, degrees. Raises `RoadFileError` if a segment is neither, or a closed line has a gap.
    """
    lengths, curvatures = [], []
    for k, segment in enumerate(segments):
        if segment.length is not None and segment.radius is None and segment.angle is None:
            lengths.append(segment.length)
            curvatures.append(0.0)
        elif segment.length is None and segment.radius is not None and segment.angle:
            lengths.append(segment.radius * math.radians(abs(segment.angle)))
            curvatures.append(math.copysign(1.0 / segment.radius, segment.angle))
        else:
            raise RoadFileError(
                f"Segment {k + 1} of the course '{name}' must have a length, or a radius and an angle that is not 0."
            )
    ends = np.concatenate([[0.0], np.cumsum(lengths)])
    n = max(4, math.ceil(ends[-1] / STEP))
    s = np.linspace(0.0, ends[-1], n + 1)
    points = np.empty((n + 1, 2))
    x, y, yaw = start[0], start[1], math.radians(start[2])
    for k, (length, curvature) in enumerate(zip(lengths, curvatures, strict=True)):
        inside = (s >= ends[k] - 1e-9) & (s <= ends[k + 1] + 1e-9)
        points[inside] = np.stack(_arc(x, y, yaw, curvature, s[inside] - ends[k]), axis=1)
        (x,), (y,) = _arc(x, y, yaw, curvature, np.array([length]))
        yaw += curvature * length
    gap = float(np.hypot(*(points[-1] - points[0])))
    if closed and gap > MAX_GAP:
        raise RoadFileError(
            f"The course '{name}' is closed, but its end misses its start by {gap:.3g} m; change its segments."
        )
    if closed:
        points[-1] = points[0]
    return _line_through_equidistant(points, closed, float(ends[-1]))


def _arc(x: float, y: float, yaw: float, curvature: float, s: Float) -> tuple[Float, Float]:
    """Points x, y, m, of an arc or a straight at distances s from its start, m. `curvature`: 1/m."""
    if curvature == 0.0:
        return x + s * math.cos(yaw), y + s * math.sin(yaw)
    end = yaw + curvature * s
    return x + (np.sin(end) - math.sin(yaw)) / curvature, y - (np.cos(end) - math.cos(yaw)) / curvature


def _line_through_equidistant(points: Float, closed: bool, length: float | None = None) -> CentreLine:
    """Line through points at equal distances. `length`: length along the line, m; by default the length of the
    chord."""
    chord = points[-1] - points[0]
    chord_length = float(np.hypot(*chord))
    deviations = np.abs(chord[0] * (points[:, 1] - points[0, 1]) - chord[1] * (points[:, 0] - points[0, 0]))
    straight = not closed and bool((deviations <= 1e-9 * chord_length * max(chord_length, 1.0)).all())
    if straight:
        points = np.linspace(points[0], points[-1], max(5, math.ceil(chord_length / STEP) + 1))
        length = chord_length
    step = (length if length is not None else chord_length) / (len(points) - 1)
    if closed:
        points = np.vstack([points[:-1], points[:1]])
    spline = CubicSpline(step * np.arange(len(points)), points, bc_type="periodic" if closed else "not-a-knot")
    return CentreLine(step, points, np.ascontiguousarray(spline.c[::-1].transpose(2, 0, 1)), closed, straight)
