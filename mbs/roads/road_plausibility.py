"""Plausibility of a road: position, extent, heights, slopes and frictions, and whether a drive starts on it."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from pathlib import Path

import numpy as np
from scipy.ndimage import distance_transform_edt

from ali3.plausibility import Mistake, Plausibility, Value, far_values, plausibility_of, quantities_of
from mbs.elements.road import GridRoad, KerbRoad, PlaneRoad
from mbs.roads.read_road import read_road
from mbs.roads.road_file import TABLE_SUFFIXES, RoadFile

MIN_LEVELS = 5
"""Least number of different heights from which the step of a number type is inferred."""
MAX_LEVELS = 4096
"""Largest number of different heights for which it is inferred."""
SLOPE_QUANTILE = 0.9
"""Quantile of the slopes that is compared: it excludes kerbs and steps."""
STEP_MANTISSAS = (1.0, 2.0, 2.5, 5.0)
"""Of steps of number types."""
MAX_POINTS = 4e6
"""Most points of a file that is read as a whole; of a larger one only the position is compared."""
UNITS = {1e-3: "mm", 1e-2: "cm", 0.0254: "inches", 0.3048: "feet", 1e3: "km"}
"""Units that are mistaken for metres, by their length in m."""
TITLE = "road"
KEYS = frozenset({"origin", "spacing"})
HEIGHTS = frozenset({"heights"})
QUANTITIES = quantities_of("road")
Start = tuple[float, float]


@dataclass(frozen=True)
class Place:
    """Location of a grid: first point and spacing, m, and numbers of points along x and y."""

    origin: tuple[float, ...]
    spacing: tuple[float, ...]
    shape: tuple[int, ...]

    @property
    def extent(self) -> list[float]:
        """Lengths of the grid along x and y, m."""
        return [h * (n - 1) for h, n in zip(self.spacing, self.shape, strict=True)]

    @property
    def keys(self) -> dict[str, list[float]]:
        """Values of the file from which the position follows, by key."""
        return {"origin": list(self.origin), "spacing": list(self.spacing)}

    def distance(self, point: Start) -> float:
        """Distance of a point from the rectangle of the grid, m; 0 inside."""
        intervals = zip(point, self.origin, self.extent, strict=True)
        return math.hypot(*(max(low - p, p - low - side, 0.0) for p, low, side in intervals))

    def scaled(self, factor: float) -> Place:
        """Position of a grid whose coordinates are in another unit. `factor`: length of that unit, m."""
        origin, spacing = (tuple(factor * v for v in pair) for pair in (self.origin, self.spacing))
        return replace(self, origin=origin, spacing=spacing)


def grid_location(road: GridRoad) -> Place:
    """Origin, spacing and numbers of points of a grid road."""
    origin, spacing = (tuple(map(float, pair)) for pair in (road.origin, road.spacing))
    return Place(origin, spacing, np.shape(road.heights))


def road_plausibility(what: str, road: PlaneRoad | KerbRoad | GridRoad, start: Start | None = None) -> Plausibility:
    """Plausibility of a road. `what`: name of the file; `start`: x and y of the start of a drive, m."""
    if not isinstance(road, GridRoad):
        return Plausibility(what, _plain_values(road), title=TITLE)
    place, z = grid_location(road), np.asarray(road.heights, float)
    mistakes, values = [], road_values(road, place, z, start)
    usual = any(v.quantity is QUANTITIES["slope"] and v.mended() for v in values)
    for factor, unit in UNITS.items():
        scaled = place.scaled(factor)
        for subject, keys, position, height_factor in (
            ("coordinates", KEYS, scaled, 1.0),
            ("heights", HEIGHTS, place, factor),
            ("coordinates and heights", KEYS | HEIGHTS, scaled, factor),
        ):
            if not (usual and keys is HEIGHTS):  # a single steep spot has another cause
                text = f"{unit} instead of m in {subject}"
                mistakes.append(Mistake(text, keys, partial(road_values, road, position, z, start, height_factor)))
    if (missing := far_values(z)).any():
        filled = partial(road_values, road, place, filled_up(z, missing), start)
        mistakes.append(Mistake(f"{z[missing][0]:g} in the place of no value in heights", HEIGHTS, filled))
    as_ratios = partial(road_values, road, place, z, start, friction_factor=0.01)
    mistakes.append(Mistake("percent instead of a ratio in frictions", frozenset({"frictions"}), as_ratios))
    if start is not None:
        mistakes += start_mistakes(place, start)
    return Plausibility(what, values, mistakes, title=TITLE)


def start_plausibility(what: str, place: Place, start: Start) -> Plausibility:
    """Plausibility of the position of a grid alone. `start`: x and y where a drive begins, m."""
    mistakes, small = start_mistakes(place, start), place.scaled(1e-3)
    if min(small.extent) > 1.0:
        mistakes.insert(0, Mistake("mm instead of m in coordinates", KEYS, partial(_position_values, small, start)))
    return Plausibility(what, _position_values(place, start), mistakes, title=TITLE)


def _position_values(place: Place, start: Start) -> list[Value]:
    """Values of the extent and of the distance from the start."""
    return [*_extent_values(place), *_distance_values(place, start)]


def start_mistakes(place: Place, start: Start) -> list[Mistake]:
    """Common mistakes by which a grid does not contain the start of a drive."""
    middle = [o + 0.5 * side for o, side in zip(place.origin, place.extent, strict=True)]
    map_text = f"coordinates of a map or another origin, of which {middle[0]:.0f}, {middle[1]:.0f} is to be taken"
    at_start = tuple(s - 0.5 * side for s, side in zip(start, place.extent, strict=True))
    return [
        Mistake(text, frozenset({"origin"}), partial(_distance_values, replace(place, origin=origin), start))
        for text, origin in (("x and y exchanged in the origin", place.origin[::-1]), (map_text, at_start))
    ]


def _distance_values(place: Place, start: Start) -> list[Value]:
    """Value of the distance of the start from the grid."""
    keys = place.keys | {"extent": place.extent, "start": list(start)}
    return [Value(QUANTITIES["away"], place.distance(start), keys)]


def _extent_values(place: Place) -> list[Value]:
    """Values of the extent along x and y."""
    sides = zip("xy", place.extent, strict=True)
    return [Value(QUANTITIES["extent"], side, {"spacing": list(place.spacing)}, axis) for axis, side in sides]


def road_values(
    road: GridRoad,
    place: Place,
    z: np.ndarray,
    start: Start | None,
    height_factor: float = 1.0,
    friction_factor: float = 1.0,
) -> list[Value]:
    """Values of all quantities of a grid.

    `place`: its position; `z`: heights, m; `height_factor`, `friction_factor`: on heights and frictions.
    """
    z, frictions = height_factor * z, friction_factor * np.asarray(road.frictions, float)
    spacing = {"spacing": list(place.spacing)}
    step = height_step(z)
    heights = {"heights": [float(z.min()), float(z.max())]}
    rises = [np.abs(np.diff(z, axis=k)) for k in range(2)]
    over = max(max(float(r.max()) - h for r, h in zip(rises, place.spacing, strict=True)), 0.0)
    slope = max(float(np.quantile(r, SLOPE_QUANTILE)) / h for r, h in zip(rises, place.spacing, strict=True))
    return [
        *_extent_values(place),
        Value(QUANTITIES["heights"], float(np.ptp(z)), heights),
        Value(QUANTITIES["spacing"], min(place.spacing), spacing, "least"),
        Value(QUANTITIES["rise"], over, heights | spacing),
        Value(QUANTITIES["step"], step, {"number type of heights": step}),
        *([Value(QUANTITIES["slope"], slope, heights | spacing)] if slope else []),
        *_friction_values(float(frictions.min()), float(frictions.max()), road.friction_factor),
        *([] if start is None else _distance_values(place, start)),
    ]


def _plain_values(road: PlaneRoad | KerbRoad) -> list[Value]:
    """Values of the quantities of a plane or a kerb."""
    slope = math.hypot(road.grade_x, road.grade_y) if isinstance(road, PlaneRoad) else 0.0
    step = road.step if isinstance(road, KerbRoad) else 0.0
    return [
        Value(QUANTITIES["rise"], step),
        Value(QUANTITIES["slope"], slope),
        *_friction_values(road.friction, road.friction, road.friction_factor),
    ]


def _friction_values(minimum: float, maximum: float, factor: float) -> list[Value]:
    """Values of the least and the largest friction of a road."""
    keys = {"frictions": [minimum, maximum], "friction_factor": factor}
    return [Value(QUANTITIES["friction"], v * factor, keys, of) for of, v in (("least", minimum), ("largest", maximum))]


def height_step(z: np.ndarray) -> float:
    """Step of which all heights are multiples, m; 0 if there is none, or if too few different heights show it."""
    levels = np.unique(z)
    if not MIN_LEVELS <= len(levels) <= MAX_LEVELS:
        return 0.0
    gaps = np.diff(levels)
    steps = gaps / gaps.min()
    # the few levels of a designed road have any distances; levels of a coarse number type are mostly one step apart
    integer_multiples = bool(np.all(np.abs(steps - np.round(steps)) < 1e-3 * np.round(steps)))
    step = float(gaps.min())
    mantissa = np.round(step / 10.0 ** np.floor(np.log10(step * (1.0 + 1e-6))), 3)
    return step if integer_multiples and float(np.median(steps)) < 1.5 and mantissa in STEP_MANTISSAS else 0.0


def filled_up(z: np.ndarray, missing: np.ndarray) -> np.ndarray:
    """Heights with the height of the nearest point where `missing` is true."""
    nearest = distance_transform_edt(missing, return_distances=False, return_indices=True)
    return np.asarray(z[tuple(nearest)])


@plausibility_of.register(PlaneRoad)
@plausibility_of.register(KerbRoad)
@plausibility_of.register(GridRoad)
def _plausibility_of_road(road: PlaneRoad | KerbRoad | GridRoad) -> list[Plausibility]:
    return [road_plausibility("", road)]


@plausibility_of.register
def file_plausibility(road: RoadFile, start: Start = (0.0, 0.0), max_points: float = MAX_POINTS) -> list[Plausibility]:
    """Plausibility of a road file, and of a start of a drive on it.

    `start`: x and y, m; `max_points`: number of points above which only the position is compared.
    """
    table = read_road(road.path) if _is_text(road) else None
    place = None
    if table is None:
        place = _place_of_header(road)
    elif isinstance(table, GridRoad):
        place = grid_location(table)
    if place is not None and math.prod(place.shape) > max_points:
        return [start_plausibility(str(road.path), place, start)]
    return [road_plausibility(str(road.path), road.read() if table is None else table, start)]


def place_of_file(road: RoadFile) -> Place | None:
    """Location of the grid of a file; None for a plane or a kerb. A table is cached until the file changes."""
    if not _is_text(road):
        return _place_of_header(road)
    file = Path(road.path).absolute()
    return _place_of_table(file, file.stat().st_mtime_ns)


def _is_text(road: RoadFile) -> bool:
    """Whether a road file is a text table, which has no header with the location of its grid."""
    return Path(road.path).suffix.lower() in TABLE_SUFFIXES


def _place_of_header(road: RoadFile) -> Place | None:
    """Location of the grid in a road file; None without a grid."""
    head = road.header
    return Place(head.real[:2], head.real[2:4], (head.nx, head.ny)) if head.nx * head.ny else None


@lru_cache(maxsize=8)
def _place_of_table(file: Path, changed: int) -> Place | None:
    """Location of the grid of a table. `changed`: time of the last change of the file, part of the key of the cache."""
    road = read_road(file)
    return grid_location(road) if isinstance(road, GridRoad) else None
