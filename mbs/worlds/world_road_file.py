"""Writes the road file of a world by rows of tiles."""

import math
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ali3.files import atomic_file
from mbs.kernel.header.limits import ROAD_TILE
from mbs.roads.road_header import check_grid
from mbs.roads.shared_tiles import TILE_COORDINATES, TOLERANCE, SharedWriter, fit_polynomials
from mbs.worlds import thinned_world as thin_world
from mbs.worlds.profiles import equidistant
from mbs.worlds.terrain import Terrain
from mbs.worlds.world_types import WorldDescription

Float = NDArray[np.float64]
Classes = NDArray[np.uint8]
SAMPLES = np.array([*range(0, ROAD_TILE - 1, 3), ROAD_TILE - 1])
"""Indices of points along the side of a tile by which its smoothness is tested."""


def grid_shape(world: WorldDescription) -> tuple[int, int]:
    """Numbers of grid points of a world along x and y."""
    (x0, y0, x1, y1), (dx, dy) = world.bounds, world.spacing
    return math.ceil((x1 - x0) / dx - 1e-9) + 1, math.ceil((y1 - y0) / dy - 1e-9) + 1


def write_world_road(
    terrain: Terrain, file: Path, tell: Callable[[float], None] = lambda part: None, thin: bool = False
) -> None:
    """Write the road file of a world.

    `tell`: called with the completed fraction, 0 to 1; `thin`: whether heights are rounded as in `thinned_world`.
    """
    x0, y0, _, _ = terrain.world.bounds
    dx, dy = terrain.world.spacing
    shape = grid_shape(terrain.world)
    uniform = float(terrain.frictions[0]) if len(terrain.names) == 1 else None
    tolerance = thin_world.TOLERANCE if thin else TOLERANCE
    with atomic_file(file) as target, target.open("wb") as out:
        writer = SharedWriter(out, shape, (x0, y0), (dx, dy), uniform, file, tolerance)
        rows, columns = writer.head.tiles
        y = equidistant(y0, dy, columns * ROAD_TILE)
        for i in range(rows):
            for heights, surfaces in _tiles(terrain, equidistant(x0 + i * ROAD_TILE * dx, dx, ROAD_TILE), y, tolerance):
                if thin and heights.shape == (ROAD_TILE, ROAD_TILE):
                    heights = thin_world.STEP * np.round(heights / thin_world.STEP)
                writer.tile(heights, None if uniform is not None else terrain.frictions[surfaces])
            tell((i + 1) / rows)
        writer.finish()


def _tiles(terrain: Terrain, x: Float, y: Float, tolerance: float) -> Iterator[tuple[Float, Classes]]:
    """Yield heights, or polynomial coefficients, and surfaces of the tiles of a row; smooth tiles are sampled."""
    count = len(y) // ROAD_TILE
    sample_indices = (ROAD_TILE * np.arange(count)[:, None] + SAMPLES).ravel()
    z, surfaces, same = terrain.on_grid(x[SAMPLES], y[sample_indices])
    check_grid(z, None, "the world")
    blocks = [_blocks(values, count) for values in (z, surfaces, same)]
    forms = fit_polynomials(blocks[0], TILE_COORDINATES[SAMPLES], 0.5 * tolerance)
    step = 0.75 * math.hypot(x[1] - x[0], y[1] - y[0]) * (SAMPLES[1] - SAMPLES[0])
    is_uniform = (blocks[1] == blocks[1][:, :1, :1]).all(axis=(1, 2)) & (blocks[2].min(axis=(1, 2)) > step)
    needs_all_points = (
        np.array([form is None for form in forms])
        | ~is_uniform
        | terrain.has_borders(x, y[::ROAD_TILE], y[ROAD_TILE - 1 :: ROAD_TILE])
    )
    numbers = np.flatnonzero(needs_all_points)
    exact_tiles: dict[int, tuple[Float, Classes]] = {}
    if len(numbers):
        z, surfaces, _ = terrain.on_grid(x, (y.reshape(count, ROAD_TILE)[numbers]).ravel())
        check_grid(z, None, "the world")
        heights, classes = _blocks(z, len(numbers)), _blocks(surfaces, len(numbers))
        exact_forms = fit_polynomials(heights, TILE_COORDINATES, tolerance)
        for k, number in enumerate(numbers.tolist()):
            form = exact_forms[k]
            exact_tiles[number] = (
                np.ascontiguousarray(heights[k]) if form is None else form,
                np.ascontiguousarray(classes[k]),
            )
    for k, form in enumerate(forms):
        if k in exact_tiles:
            yield exact_tiles[k]
        elif form is not None:
            yield form, blocks[1][k, :1, :1]


def _blocks(values: NDArray[Any], count: int) -> NDArray[Any]:
    """Split values of a row of tiles, shape (n, count n), into tiles, shape (count, n, n)."""
    n = len(values)
    return np.asarray(values.reshape(n, count, n).transpose(1, 0, 2))
