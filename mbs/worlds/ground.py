"""Ground of a world without courses, areas and obstacles."""

import math
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import map_coordinates, spline_filter

from ali3.named_files import NamedFiles
from mbs.roads.description import grid_road
from mbs.roads.grid_files import MAX_BYTES
from mbs.roads.road_header import RoadFileError
from mbs.worlds.profiles import equidistant
from mbs.worlds.world_types import WorldDescription

Float = NDArray[np.float64]


class Surface:
    """Heights at the points of a regular grid, a C2 cubic spline between them.

    `x`, `y`: rising at equal distances, at least four each, m, shapes (n,) and (m,); `heights`: m, shape (n, m).
    """

    def __init__(self, x: Float, y: Float, heights: Float) -> None:
        self.x, self.y = x, y
        self._steps = (x[-1] - x[0]) / (len(x) - 1), (y[-1] - y[0]) / (len(y) - 1)
        self._level = float(heights.flat[0]) if (heights == heights.flat[0]).all() else None
        self._weights = heights if self._level is not None else spline_filter(heights, order=3, mode="mirror")

    def on_grid(self, x: Float, y: Float) -> Float:
        """Heights at all pairs of coordinates x (n,) and y (m,), m, shape (n, m)."""
        if self._level is not None:
            return np.full((len(x), len(y)), self._level)
        (i, a), (j, b) = self._basis(x, 0), self._basis(y, 1)
        rows = np.zeros((len(x), self._weights.shape[1]))
        for k in range(4):
            rows += a[k][:, None] * self._weights[i[k]]
        heights = np.zeros((len(x), len(y)))
        for k in range(4):
            heights += b[k] * rows[:, j[k]]
        return heights

    def _basis(self, values: Float, axis: int) -> tuple[list[NDArray[np.int64]], list[Float]]:
        """Indices of the four grid points around each value, mirrored at the border, and cubic B-spline weights."""
        n = self._weights.shape[axis]
        position = np.clip((values - (self.x, self.y)[axis][0]) / self._steps[axis], 0.0, n - 1.0)
        first = np.minimum(np.floor(position), n - 2.0)
        t = position - first
        weights = [
            (1.0 - t) ** 3 / 6.0,
            (3.0 * t**3 - 6.0 * t**2 + 4.0) / 6.0,
            (3.0 * (1.0 - t) ** 3 - 6.0 * (1.0 - t) ** 2 + 4.0) / 6.0,
            t**3 / 6.0,
        ]
        neighbours = [np.abs(np.asarray(first, np.int64) + k) for k in (-1, 0, 1, 2)]
        return [np.where(k > n - 1, 2 * (n - 1) - k, k) for k in neighbours], weights

    def at(self, x: Float, y: Float) -> Float:
        """Heights at points of one shape, m."""
        if self._level is not None:
            return np.full(np.shape(x), self._level)
        positions = [(v - (self.x, self.y)[k][0]) / self._steps[k] for k, v in enumerate((x, y))]
        clipped = [np.clip(positions[k], 0.0, self._weights.shape[k] - 1.0) for k in range(2)]
        return np.asarray(map_coordinates(self._weights, clipped, order=3, mode="mirror", prefilter=False))


def make_ground(world: WorldDescription, folder: Path) -> tuple[Surface, float]:
    """Make the ground of a world; return it with the spacing of its height map, m, or infinity without one.

    Raises `RoadFileError` if the height map cannot be read, or does not cover the world.
    """
    ground, (x0, y0, x1, y1) = world.ground, world.bounds
    if ground.heights is not None and ground.variation is not None:
        raise RoadFileError("The ground has heights and a variation; it may have one of them.")
    if ground.heights is not None:
        return _height_map(world, folder)
    step = ground.variation.length if ground.variation is not None else max(x1 - x0, y1 - y0)
    x = equidistant(x0 - 2.0 * step, step, math.ceil((x1 - x0) / step) + 5)
    y = equidistant(y0 - 2.0 * step, step, math.ceil((y1 - y0) / step) + 5)
    heights = np.full((len(x), len(y)), ground.height)
    if ground.variation is not None:
        random = np.random.default_rng(ground.variation.seed)
        heights += ground.variation.height * random.standard_normal(heights.shape)
    return Surface(x, y, heights), math.inf


def _height_map(world: WorldDescription, folder: Path) -> tuple[Surface, float]:
    """Read the ground from a height map; return it with the least spacing of the map, m."""
    ground = world.ground
    assert ground.heights is not None
    file = NamedFiles(folder, MAX_BYTES, RoadFileError).file(ground.heights, folder, "The heights of the ground")
    grid = grid_road(file, None, ground.origin, ground.spacing, ground.height_range, None)
    heights = np.asarray(grid.heights, float) + ground.height
    x, y = (equidistant(grid.origin[k], grid.spacing[k], heights.shape[k]) for k in range(2))
    for axis, low, high, first, last in zip(
        "xy", world.bounds[:2], world.bounds[2:], (x[0], y[0]), (x[-1], y[-1]), strict=True
    ):
        if low < first - 1e-6 or high > last + 1e-6:
            raise RoadFileError(
                f"The world reaches from {axis} = {low:g} to {high:g} m, its height map {file} from {first:g} to "
                f"{last:g} m; the map must cover it."
            )
    if min(heights.shape) < 4:
        raise RoadFileError(f"{file} has {heights.shape[0]} x {heights.shape[1]} points; at least 4 x 4 are needed.")
    steepest = max(float(np.abs(np.diff(heights, axis=k)).max()) / grid.spacing[k] for k in range(2))
    if steepest > 5.0:
        raise RoadFileError(
            f"The height map {file} is as steep as {100.0 * steepest:.0f} %; its heights and spacing must be in metres."
        )
    return Surface(x, y, heights), min(grid.spacing)
