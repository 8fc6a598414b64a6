"""Reduced world for a page: spacing, tolerance and step of its heights, and their deviation."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ali3.reading import LARGEST_IN_PARTS, open_file
from mbs.kernel.header.limits import ROAD_TILE
from mbs.roads.road_header import RoadFileError, read_header
from mbs.roads.shared_tiles import read_shared
from mbs.worlds.terrain import Terrain

SPACING = (0.1, 0.2)
"""Least distances of the points along x and y, m."""
TOLERANCE = 5e-4
"""Largest deviation of the polynomials of tiles, m."""
STEP = 2.0**-12
"""Heights of the road file and of the drawing are integer multiples of it, m."""
SAMPLES = 16
"""Number of cells per tile in whose middle heights are compared."""


@dataclass(frozen=True)
class Deviation:
    """Largest deviation of the heights of a thinned world, m, its 99.9 % quantile, m, and the number of samples."""

    largest: float
    quantile: float
    count: int

    @property
    def sentence(self) -> str:
        """Deviation of the heights as a sentence."""
        return (
            f"Thin ground: its heights are off by at most {1e3 * self.largest:.3g} mm and by "
            f"{1e3 * self.quantile:.2g} mm in 99.9 % of {self.count} places."
        )


def thinned_spacing(spacing: tuple[float, float]) -> tuple[float, float]:
    """Spacing of the points of the thinned world along x and y, m."""
    return max(spacing[0], SPACING[0]), max(spacing[1], SPACING[1])


def measure_thinning(terrain: Terrain, road: Path) -> Deviation:
    """Compare a road file with the terrain in the middle of `SAMPLES` cells of every tile."""
    generator = np.random.default_rng(1)
    differences = []
    with open_file(road, LARGEST_IN_PARTS, RoadFileError) as file:
        head = read_header(file, road)
        x0, y0, dx, dy = head.real[:4]
        tile_columns = head.tiles[1]
        for number, (z, *_) in read_shared(file, head, road):
            i, j = generator.integers(0, ROAD_TILE - 1, (2, SAMPLES))
            rows, columns = (number // tile_columns) * ROAD_TILE + i, (number % tile_columns) * ROAD_TILE + j
            inside = (rows < head.nx - 1) & (columns < head.ny - 1)
            middle = 0.25 * (z[i, j] + z[i + 1, j] + z[i, j + 1] + z[i + 1, j + 1])
            x, y = x0 + (rows + 0.5) * dx, y0 + (columns + 0.5) * dy
            differences.append(np.abs(middle - terrain.at(x, y))[inside])
    deviations = np.concatenate(differences)
    return Deviation(float(deviations.max()), float(np.quantile(deviations, 0.999)), len(deviations))
