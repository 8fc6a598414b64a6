"""Layers on the ground of a world, courses and level areas: their height and weight at any point."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.ndimage import gaussian_filter1d
from scipy.spatial import cKDTree

from mbs.worlds.centre_line import CentreLine
from mbs.worlds.profiles import soft_rise, steps, vertical_curve
from mbs.worlds.world_types import Area, Course

Float = NDArray[np.float64]
HeightOf = Callable[[Float, Float], Float]
OUT_OF_REACH = 1e6
"""Distance of points beyond the reach of a layer, m."""


@dataclass(frozen=True)
class LayerPoints:
    """Values of a layer at points, arrays of one shape."""

    excess: Float
    """Distance from the surface of the layer, m; 0 or less on it."""
    height: Float
    """Height of the layer, m."""
    station: Float
    """Station on a course, m."""
    offset: Float
    """Offset from the centre line of a course to the left, m."""


class Layer(Protocol):
    """A course or an area."""

    name: str
    surface: str
    shoulder: float
    blend: float

    def near(self, x: Float, y: Float) -> tuple[Float, Float]:
        """Approximate distances of points from the surface and their stations, m; `OUT_OF_REACH` beyond its reach."""

    def at(self, x: Float, y: Float, guess: Float) -> LayerPoints:
        """Values at points. `guess`: approximate stations, m."""


def weight(layer: Layer, excess: Float) -> Float:
    """Weight of a layer against the ground, C2: 1 on the layer and its shoulder, 0 beyond its blend."""
    return np.asarray(1.0 - soft_rise((excess - layer.shoulder) / layer.blend))


class CourseLayer:
    """A course on the ground.

    `ground`: heights of the ground, which a course without heights follows; `heights`, `widths`, `banks`: profiles of a
    course from a file at the points of the line, shape (n,).
    """

    def __init__(
        self,
        course: Course,
        line: CentreLine,
        ground: HeightOf,
        heights: Float | None = None,
        widths: Float | None = None,
        banks: Float | None = None,
    ) -> None:
        self.name: str = course.name
        self.surface: str = course.surface
        self.course, self.line = course, line
        self.shoulder, self.blend = course.shoulder, course.blend
        self.widths, self.banks = widths, banks
        self.reach = 0.5 * (course.width if widths is None else float(widths.max())) + self.shoulder + self.blend
        self.height: Callable[[Float], Float]
        """Heights of the centre line at stations, m."""
        if course.heights is not None:
            roundings = [course.rounding] * len(course.heights)
            vertices = course.heights
            self.height = lambda s: vertical_curve(s, vertices, roundings)
        else:
            if heights is None:
                heights = ground(*line.points.T)
            self.height = _smooth_heights(heights, line, 0.25 * course.smoothing / line.step)
        self.tree = cKDTree(line.points)

    def half(self, s: Float) -> Float:
        """Half the width at stations, m."""
        if self.widths is None:
            return np.full(np.shape(s), 0.5 * self.course.width)
        return np.asarray(0.5 * np.interp(s, self.line.stations, self.widths))

    def bank(self, s: Float) -> Float:
        """Cross slope at stations, positive if the right side is higher."""
        if self.banks is not None:
            return np.asarray(np.interp(s, self.line.stations, self.banks))
        bank = self.course.bank
        return np.zeros(np.shape(s)) if bank is None else steps(s, bank.grades)

    def near(self, x: Float, y: Float) -> tuple[Float, Float]:
        distance, k = self.tree.query(np.stack([x, y], axis=-1), distance_upper_bound=self.reach + 5.0)
        s = self.line.step * np.minimum(k, len(self.line.points) - 1)
        return np.where(np.isfinite(distance), distance - self.half(s), OUT_OF_REACH), s

    def at(self, x: Float, y: Float, guess: Float) -> LayerPoints:
        s, offset, distance = self.line.beside(x, y, guess)
        half = self.half(s)
        bank = self.course.bank
        pivot = {"left": half, "centre": 0.0 * half, "right": -half}[bank.pivot if bank is not None else "centre"]
        height = self.height(s) + self.bank(s) * (pivot - offset)
        return LayerPoints(distance - half, height, s, offset)


def _smooth_heights(heights: Float, line: CentreLine, width: float) -> Callable[[Float], Float]:
    """Spline through heights at the points of a line, smoothed by a Gaussian; `width`: its deviation in points."""
    if not line.closed:
        spline = CubicSpline(line.stations, gaussian_filter1d(heights, width, mode="nearest"), bc_type="natural")
    else:
        smooth = gaussian_filter1d(heights[:-1], width, mode="wrap")
        spline = CubicSpline(line.stations, np.append(smooth, smooth[0]), bc_type="periodic")
    return lambda s: np.asarray(spline(s), np.float64)


class AreaLayer:
    """A level circle or rectangle on the ground."""

    def __init__(self, area: Area) -> None:
        self.name: str = area.name
        self.surface: str = area.surface
        self.area = area
        self.shoulder, self.blend = area.shoulder, area.blend

    def near(self, x: Float, y: Float) -> tuple[Float, Float]:
        return self._excess(x, y), np.zeros(np.shape(x))

    def at(self, x: Float, y: Float, guess: Float) -> LayerPoints:
        zero = np.zeros(np.shape(x))
        return LayerPoints(self._excess(x, y), zero + self.area.height, zero, zero)

    def _excess(self, x: Float, y: Float) -> Float:
        """Distances from the border of the area, m; negative inside."""
        dx, dy = x - self.area.at[0], y - self.area.at[1]
        if self.area.radius is not None:
            return np.asarray(np.hypot(dx, dy) - self.area.radius)
        assert self.area.size is not None
        a, b = np.abs(dx) - 0.5 * self.area.size[0], np.abs(dy) - 0.5 * self.area.size[1]
        return np.asarray(np.hypot(np.maximum(a, 0.0), np.maximum(b, 0.0)) + np.minimum(np.maximum(a, b), 0.0))
