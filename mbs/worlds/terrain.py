"""Height and surface of a world at any point, for the road file and the scene."""

import math
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mbs.roads.road_header import RoadFileError
from mbs.worlds.course_file import course_layer
from mbs.worlds.ground import Surface, make_ground
from mbs.worlds.layers import OUT_OF_REACH, AreaLayer, Layer, weight
from mbs.worlds.obstacles import Footprint, added_height, footprint
from mbs.worlds.profiles import equidistant, soft_rise
from mbs.worlds.world_types import FRICTIONS, Area, WorldDescription

Float = NDArray[np.float64]
MAX_NODES = 1_500_000
"""Largest number of points of the lattice of the ground with its layers."""
MAX_SLOPE = 3.0
"""Slope of a layer times its weight above which it has a step."""
TRANSITION = 1.0
"""Width of the transition from the heights of a layer with its shoulder to the lattice's, m."""


class Terrain:
    """The ground of a world with its layers and obstacles.

    Heights on courses, areas and their shoulders are computed at each point; elsewhere they are taken from a C2 spline
    through the points of a lattice with a spacing of about 1 m.

    `folder`: folder of the files that the description names.
    """

    def __init__(self, world: WorldDescription, folder: Path) -> None:
        self.world = world
        self.ground, map_step = make_ground(world, folder)
        self.layers: list[Layer] = []
        for course in world.courses:
            self.layers.append(course_layer(course, folder, world.bounds, self.ground.at))
        self.layers += [AreaLayer(_check_area(area)) for area in world.areas]
        names = [world.ground.surface, *(layer.surface for layer in self.layers)]
        names += [part.surface for part in (*world.bands, *world.obstacles)]
        self.names = list(dict.fromkeys(names))
        frictions = {str(name): value for name, value in world.frictions.items()}
        self.frictions = np.array([frictions.get(name, FRICTIONS[name]) for name in self.names])
        self.obstacles = [(footprint(part), part) for part in world.obstacles]
        self.bands = [(footprint(part), part) for part in world.bands]
        self._build_lattice(map_step)

    def _build_lattice(self, map_step: float) -> None:
        """Compute heights, layers and stations at the points of the lattice. `map_step`: spacing of a height map, m."""
        x0, y0, x1, y1 = self.world.bounds
        step = max(min(1.0, map_step), math.sqrt((x1 - x0) * (y1 - y0) / MAX_NODES))
        self.step = step
        self.x = equidistant(x0 - 4.0 * step, step, math.ceil((x1 - x0) / step) + 9)
        self.y = equidistant(y0 - 4.0 * step, step, math.ceil((y1 - y0) / step) + 9)
        z = self.ground.on_grid(
            np.clip(self.x, self.ground.x[0], self.ground.x[-1]), np.clip(self.y, self.ground.y[0], self.ground.y[-1])
        )
        x, y = np.meshgrid(self.x, self.y, indexing="ij")
        self.excess = np.full((len(self.layers), *z.shape), OUT_OF_REACH, np.float32)
        self.station = np.zeros((len(self.layers), *z.shape), np.float32)
        self.nearest = np.full(z.shape, OUT_OF_REACH, np.float32)
        for k, layer in enumerate(self.layers):
            excess, station = layer.near(x, y)
            self.excess[k], self.station[k] = excess, station
            self.nearest = np.minimum(self.nearest, self.excess[k] - np.float32(layer.shoulder))
            mask = excess < layer.shoulder + layer.blend + step
            points = layer.at(x[mask], y[mask], station[mask])
            fraction = weight(layer, points.excess)
            z[mask] += fraction * (points.height - z[mask])
            self._check_steps(layer, mask, fraction, points.height)
        self.carved = Surface(self.x, self.y, z)

    def _check_steps(self, layer: Layer, mask: NDArray[np.bool_], fraction: Float, height: Float) -> None:
        """Raise `RoadFileError` if a course comes so near to itself that one part cuts into the other."""
        level, fractions = np.zeros(mask.shape), np.zeros(mask.shape)
        level[mask], fractions[mask] = height, fraction
        for axis in (0, 1):
            rise = np.abs(np.diff(level, axis=axis))
            smaller_fraction = np.minimum(*(np.delete(fractions, k, axis=axis) for k in (0, -1)))
            step = rise * smaller_fraction
            if step.size and step.max() > MAX_SLOPE * self.step:
                i, j = np.unravel_index(int(np.argmax(step)), step.shape)
                neighbour = (i + 1, j) if axis == 0 else (i, j + 1)
                raise RoadFileError(
                    f"The course '{layer.name}' comes so near to itself at x = {self.x[i]:.5g}, y = {self.y[j]:.5g} m "
                    f"that its heights there, {level[i, j]:.3g} and {level[neighbour]:.3g} m, make a step; "
                    "make its blend smaller or move it."
                )

    def _node(self, values: Float, coordinates: Float) -> NDArray[np.int64]:
        """Indices of the nearest points of the lattice along an axis. `coordinates`: its coordinates, m."""
        return np.asarray(
            np.clip(np.rint((values - coordinates[0]) / self.step), 0.0, len(coordinates) - 1.0), np.int64
        )

    def on_grid(self, x: Float, y: Float) -> tuple[Float, NDArray[np.uint8], Float]:
        """Heights, surfaces as indices in `names`, and their extents, at all pairs of rising coordinates.

        `x`, `y`: m, shapes (n,) and (m,).

        Returns
        -------
        heights : ndarray, shape (n, m)
            m.
        surfaces : ndarray, shape (n, m)
        same : ndarray, shape (n, m)
            Distance from each point within which courses and areas do not change the surface, m.
        """
        z = self.carved.on_grid(x, y)
        surfaces, same = np.zeros(z.shape, np.uint8), np.full(z.shape, TRANSITION)
        i, j = self._node(x, self.x), self._node(y, self.y)
        rows, columns = np.nonzero(self.nearest[np.ix_(i, j)] < TRANSITION + self.step)
        if len(rows):
            indices = (rows, columns)
            z[indices], surfaces[indices], same[indices] = self._with_layers(
                x[rows], y[columns], i[rows], j[columns], z[indices]
            )
        for base, band in self.bands:
            if (block := _block(base, x, y)) is not None:
                inside = base.inside(x[block[0], None], y[None, block[1]])
                surfaces[block][inside] = self.names.index(band.surface)
        for base, obstacle in self.obstacles:
            if (block := _block(base, x, y)) is not None:
                px, py = x[block[0], None], y[None, block[1]]
                z[block] += added_height(obstacle, px, py)
                surfaces[block][base.inside(px, py)] = self.names.index(obstacle.surface)
        return z, surfaces, same

    def at(self, x: Float, y: Float) -> Float:
        """Heights at points, arrays of one shape, m."""
        shape, x, y = np.shape(x), np.ravel(x), np.ravel(y)
        z = self.carved.at(x, y)
        i, j = self._node(x, self.x), self._node(y, self.y)
        indices = np.flatnonzero(self.nearest[i, j] < TRANSITION + self.step)
        if len(indices):
            z[indices] = self._with_layers(x[indices], y[indices], i[indices], j[indices], z[indices])[0]
        for base, obstacle in self.obstacles:
            inside = np.flatnonzero(base.inside(x, y))
            if len(inside):
                z[inside] += added_height(obstacle, x[inside], y[inside])
        return np.asarray(z.reshape(shape))

    def has_borders(self, x: Float, first: Float, last: Float) -> NDArray[np.bool_]:
        """Whether rectangles, from x[0] to x[-1] and in y from `first` to `last`, meet an obstacle or a band."""
        meets = np.zeros(len(first), bool)
        for base, _ in (*self.bands, *self.obstacles):
            x0, y0, x1, y1 = base.box()
            if x[-1] < x0 or x[0] > x1:
                continue
            meets |= (last >= y0) & (first <= y1)
        return meets

    def nearest_layer(self, x: Float, y: Float) -> Float:
        """Approximate distances of points from the nearest layer with its shoulder, m; at most `OUT_OF_REACH`."""
        return self.nearest[self._node(x, self.x), self._node(y, self.y)].astype(float)

    def _with_layers(
        self, x: Float, y: Float, i: NDArray[np.int64], j: NDArray[np.int64], carved: Float
    ) -> tuple[Float, NDArray[np.uint8], Float]:
        """Heights, surfaces and extents as in `on_grid` at points near layers; `i`, `j`: nearest lattice points."""
        z = self.ground.at(x, y)
        surfaces = np.zeros(len(x), np.uint8)
        nearest, same = np.full(len(x), OUT_OF_REACH), np.full(len(x), OUT_OF_REACH)
        for k, layer in enumerate(self.layers):
            indices = np.flatnonzero(self.excess[k][i, j] < layer.shoulder + layer.blend + self.step)
            if len(indices) == 0:
                continue
            guess = self.station[k][i[indices], j[indices]].astype(float)
            points = layer.at(x[indices], y[indices], guess)
            z[indices] += weight(layer, points.excess) * (points.height - z[indices])
            surfaces[indices[points.excess <= 0.0]] = self.names.index(layer.surface)
            same[indices] = np.minimum(same[indices], np.abs(points.excess))
            nearest[indices] = np.minimum(nearest[indices], points.excess - layer.shoulder)
        return carved + (1.0 - soft_rise(nearest / TRANSITION)) * (z - carved), surfaces, same


def _block(base: Footprint, x: Float, y: Float) -> tuple[slice, slice] | None:
    """Rows and columns of a grid within the box of a footprint; None if there are none."""
    x0, y0, x1, y1 = base.box()
    rows = slice(int(np.searchsorted(x, x0)), int(np.searchsorted(x, x1, "right")))
    columns = slice(int(np.searchsorted(y, y0)), int(np.searchsorted(y, y1, "right")))
    return None if rows.start >= rows.stop or columns.start >= columns.stop else (rows, columns)


def _check_area(area: Area) -> Area:
    """The area itself. Raises `RoadFileError` if it has no radius and no size, or both."""
    if (area.radius is None) == (area.size is None):
        raise RoadFileError(f"The area '{area.name}' must have a radius or a size.")
    return area
