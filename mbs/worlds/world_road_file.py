"""The road file of a world: its heights and frictions at regular points, row of tiles by row of tiles."""

import math
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ali3.files import atomic_file
from mbs.kernel.header.limits import ROAD_TILE
from mbs.roads.road_header import check_grid
from mbs.roads.shared_tiles import TILE_COORDINATES, TOLERANCE, SharedWriter, polynomials_of
from mbs.worlds import thinned_world as thin_world
from mbs.worlds.profiles import spaced
from mbs.worlds.terrain import Terrain
from mbs.worlds.world_types import WorldDescription

Float = NDArray[np.float64]
Classes = NDArray[np.uint8]
SOME = np.array([*range(0, ROAD_TILE - 1, 3), ROAD_TILE - 1])
"""Points along the side of a tile that say whether it is smooth."""


def points_of(world: WorldDescription) -> tuple[int, int]:
    """Numbers of points along x and y that wheels feel."""
    (x0, y0, x1, y1), (dx, dy) = world.bounds, world.spacing
    return math.ceil((x1 - x0) / dx - 1e-9) + 1, math.ceil((y1 - y0) / dy - 1e-9) + 1


def write_world_road(
    terrain: Terrain, file: Path, tell: Callable[[float], None] = lambda part: None, thin: bool = False
) -> None:
    """Write the road file of a world.

    `tell`: called with the part that is done, 0 to 1; `thin`: rounded, for a page; see `thin_world`.
    """
    x0, y0, _, _ = terrain.world.bounds
    dx, dy = terrain.world.spacing
    shape = points_of(terrain.world)
    uniform = float(terrain.frictions[0]) if len(terrain.names) == 1 else None
    tolerance = thin_world.TOLERANCE if thin else TOLERANCE
    with atomic_file(file) as target, target.open("wb") as out:
        writer = SharedWriter(out, shape, (x0, y0), (dx, dy), uniform, file, tolerance)
        rows, columns = writer.head.tiles
        y = spaced(y0, dy, columns * ROAD_TILE)
        for i in range(rows):
            for heights, surfaces in _tiles(terrain, spaced(x0 + i * ROAD_TILE * dx, dx, ROAD_TILE), y, tolerance):
                if thin and heights.shape == (ROAD_TILE, ROAD_TILE):
                    heights = thin_world.STEP * np.round(heights / thin_world.STEP)
                writer.tile(heights, None if uniform is not None else terrain.frictions[surfaces])
            tell((i + 1) / rows)
        writer.finish()


def _tiles(terrain: Terrain, x: Float, y: Float, tolerance: float) -> Iterator[tuple[Float, Classes]]:
    """Heights, or their coefficients, and surfaces of the tiles of a row: smooth ones from a part of their points."""
    count = len(y) // ROAD_TILE
    some = (ROAD_TILE * np.arange(count)[:, None] + SOME).ravel()
    z, surfaces, same = terrain.on_grid(x[SOME], y[some])
    check_grid(z, None, "the world")
    blocks = [_blocks(values, count) for values in (z, surfaces, same)]
    forms = polynomials_of(blocks[0], TILE_COORDINATES[SOME], 0.5 * tolerance)
    step = 0.75 * math.hypot(x[1] - x[0], y[1] - y[0]) * (SOME[1] - SOME[0])
    level = (blocks[1] == blocks[1][:, :1, :1]).all(axis=(1, 2)) & (blocks[2].min(axis=(1, 2)) > step)
    whole = (
        np.array([form is None for form in forms])
        | ~level
        | terrain.has_borders(x, y[::ROAD_TILE], y[ROAD_TILE - 1 :: ROAD_TILE])
    )
    numbers = np.flatnonzero(whole)
    found: dict[int, tuple[Float, Classes]] = {}
    if len(numbers):
        z, surfaces, _ = terrain.on_grid(x, (y.reshape(count, ROAD_TILE)[numbers]).ravel())
        check_grid(z, None, "the world")
        fine, kinds = _blocks(z, len(numbers)), _blocks(surfaces, len(numbers))
        close = polynomials_of(fine, TILE_COORDINATES, tolerance)
        for k, number in enumerate(numbers.tolist()):
            form = close[k]
            found[number] = np.ascontiguousarray(fine[k]) if form is None else form, np.ascontiguousarray(kinds[k])
    for k, form in enumerate(forms):
        if k in found:
            yield found[k]
        elif form is not None:
            yield form, blocks[1][k, :1, :1]


def _blocks(values: NDArray[Any], count: int) -> NDArray[Any]:
    """Tiles of a row, shape (count, n, n)."""
    n = len(values)
    return np.asarray(values.reshape(n, count, n).transpose(1, 0, 2))
