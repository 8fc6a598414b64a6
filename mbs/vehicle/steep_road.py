"""Warns of roads with faces that the wheels of a car cannot climb."""

import warnings
from pathlib import Path

from mbs.elements.road import GridRoad, Road, RoadOfFile
from mbs.roads.read_road import read_road
from mbs.roads.road_file import TABLE_SUFFIXES, RoadFile
from mbs.roads.steep_faces import RoadWarning, steep_face

MAX_POINTS = 4e6


def warn_of_steep_face(road: Road | RoadOfFile, radius: float) -> None:
    """Warn of a grid with a wall for a wheel.

    Parameters
    ----------
    road : Road or RoadFile
        Road of a car. A file of more than `MAX_POINTS` points is not checked: it was when it was made.
    radius : float
        Radius of the largest wheel, m.
    """
    grid: Road | RoadOfFile | None = road
    name: object = "The grid road"
    if isinstance(road, RoadFile):
        table = Path(road.path).suffix.lower() in TABLE_SUFFIXES
        name, small = road.path, table or road.header.nx * road.header.ny <= MAX_POINTS
        grid = read_road(name) if small else None
    if isinstance(grid, GridRoad) and (warning := steep_face(grid, name, radius)):
        warnings.warn(warning, RoadWarning, stacklevel=3)
