"""A world that a page can carry: fewer and rounder numbers of its ground, and how far they are off."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ali3.reading import LARGEST_IN_PARTS, open_file
from mbs.kernel.header.limits import ROAD_TILE
from mbs.roads.road_header import RoadFileError, read_header
from mbs.roads.shared_tiles import read_shared
from mbs.worlds.terrain import Terrain

SPACING = (0.1, 0.2)
"""m: least distances of the points along x and y."""
TOLERANCE = 5e-4
"""m: heights of a tile that are nearer to a polynomial are stored as it."""
STEP = 2.0**-12
"""m: heights, felt and drawn, are whole multiples of it."""
LOOKED_AT = 16
"""Cells of a tile in whose middle the heights are compared."""


@dataclass(frozen=True)
class Deviation:
    """Deviation of the heights of a thinned world, m: the largest, and the 99.9 % quantile."""

    most: float
    nearly_all: float
    places: int

    @property
    def sentence(self) -> str:
        """Deviation of the heights as a sentence."""
        return (
            f"Thin ground: its heights are off by at most {1e3 * self.most:.3g} mm and by "
            f"{1e3 * self.nearly_all:.2g} mm in 99.9 % of {self.places} places."
        )


def thinner(spacing: tuple[float, float]) -> tuple[float, float]:
    """Distances of the points of the thin world."""
    return max(spacing[0], SPACING[0]), max(spacing[1], SPACING[1])


def off_by(terrain: Terrain, road: Path) -> Deviation:
    """Compare a road file with the terrain in the middle of some cells of every tile.

    `road`: as it lies on the disk.
    """
    generator = np.random.default_rng(1)
    differences = []
    with open_file(road, LARGEST_IN_PARTS, RoadFileError) as file:
        head = read_header(file, road)
        x0, y0, dx, dy = head.real[:4]
        tile_columns = head.tiles[1]
        for number, (z, *_) in read_shared(file, head, road):
            i, j = generator.integers(0, ROAD_TILE - 1, (2, LOOKED_AT))
            rows, columns = (number // tile_columns) * ROAD_TILE + i, (number % tile_columns) * ROAD_TILE + j
            inside = (rows < head.nx - 1) & (columns < head.ny - 1)
            middle = 0.25 * (z[i, j] + z[i + 1, j] + z[i, j + 1] + z[i + 1, j + 1])
            x, y = x0 + (rows + 0.5) * dx, y0 + (columns + 0.5) * dy
            differences.append(np.abs(middle - terrain.at(x, y))[inside])
    deviations = np.concatenate(differences)
    return Deviation(float(deviations.max()), float(np.quantile(deviations, 0.999)), len(deviations))
