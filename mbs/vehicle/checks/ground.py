"""The ground under a car: whether it is level, and walls of a grid that stop a wheel."""

import math
import warnings
from pathlib import Path

import numpy as np

from mbs.elements.road import GridRoad, PlaneRoad, Road, RoadOfFile
from mbs.roads.read_road import read_road
from mbs.roads.road_file import TABLE_SUFFIXES, RoadFile
from mbs.roads.steep_faces import RoadWarning, steep_face

MAX_CHECKED_POINTS = 4e6  # of a file whose faces are checked


def level_within(road: Road | RoadOfFile | None, footprint: tuple[tuple[float, float], tuple[float, float]]) -> bool:
    """Whether a road is level under the car as drawn.

    Parameters
    ----------
    road : Road, RoadFile or None
        None: level. Of a file the road in its place, as the kernel raises the start to the height of the file.
    footprint : pair of (float, float)
        Least and largest x and y of the car, m.
    """
    if isinstance(road, RoadOfFile):
        road = road.road
    if isinstance(road, PlaneRoad):
        return road.grade_x == 0.0 and road.grade_y == 0.0
    if isinstance(road, GridRoad):
        heights = np.asarray(road.heights, float)
        cells = []
        for k, (low, high) in enumerate(footprint):
            # a cell takes its slopes from one point more on each side
            first = math.floor((low - road.origin[k]) / road.spacing[k]) - 1
            last = math.ceil((high - road.origin[k]) / road.spacing[k]) + 1
            cells.append(np.clip(np.arange(first, last + 1), 0, heights.shape[k] - 1))
        return float(np.ptp(heights[np.ix_(*cells)])) == 0.0
    return True


def warn_of_steep_face(road: Road | RoadOfFile, radius: float) -> None:
    """Warn of a grid with a wall for a wheel.

    Parameters
    ----------
    road : Road or RoadFile
        Road of a car. A file of more than `MAX_CHECKED_POINTS` points is not checked: it was when it was made.
    radius : float
        Radius of the largest wheel, m.
    """
    grid: Road | RoadOfFile | None = road
    name: object = "The grid road"
    if isinstance(road, RoadFile):
        table = Path(road.path).suffix.lower() in TABLE_SUFFIXES
        name, small = road.path, table or road.header.nx * road.header.ny <= MAX_CHECKED_POINTS
        grid = read_road(name) if small else None
    if isinstance(grid, GridRoad) and (warning := steep_face(grid, name, radius)):
        warnings.warn(warning, RoadWarning, stacklevel=4)
