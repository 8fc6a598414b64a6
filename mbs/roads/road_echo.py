"""What was understood of a road: where it lies, how high and steep it is, and whether a drive begins on it."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np

from ali3.echo import Echo, Mistake, Value, echo_of, quantities_of
from mbs.elements.road import GridRoad, KerbRoad, PlaneRoad
from mbs.roads.read_road import read_road
from mbs.roads.road_file import TEXTS, RoadFile

MOST_LEVELS, FEWEST_LEVELS = 4096, 5
MOST_POINTS = 4e6
"""Of a file that is read for its summary; of more its place alone is looked at."""
MM, TITLE = 1e-3, "road"
KEYS = frozenset({"origin", "spacing"})
QUANTITIES = quantities_of("road")
Start = tuple[float, float]


@dataclass(frozen=True)
class Place:
    """Where a grid lies: first point and spacing, m, and numbers of points."""

    origin: tuple[float, ...]
    spacing: tuple[float, ...]
    shape: tuple[int, ...]

    @property
    def extent(self) -> list[float]:
        """Along x and y, m."""
        return [h * (n - 1) for h, n in zip(self.spacing, self.shape, strict=True)]

    @property
    def keys(self) -> dict[str, list[float]]:
        """What it follows from."""
        return {"origin": list(self.origin), "spacing": list(self.spacing)}

    def distance(self, point: Start) -> float:
        """From a point to its rectangle, m; 0 within."""
        ends = zip(point, self.origin, self.extent, strict=True)
        return math.hypot(*(max(low - p, p - low - side, 0.0) for p, low, side in ends))

    def in_mm(self) -> Place:
        """It with coordinates that were in mm."""
        return replace(self, origin=tuple(MM * v for v in self.origin), spacing=tuple(MM * v for v in self.spacing))


def place_of(road: GridRoad) -> Place:
    """Where a grid lies."""
    origin, spacing = (tuple(map(float, pair)) for pair in (road.origin, road.spacing))
    return Place(origin, spacing, np.shape(road.heights))


def road_echo(what: str, road: PlaneRoad | KerbRoad | GridRoad, start: Start | None = None) -> Echo:
    """What was understood of a road. `what`: the file; `start`: x and y where a drive begins, m."""
    if not isinstance(road, GridRoad):
        return Echo(what, _plain_values(road), title=TITLE)
    place, z = place_of(road), np.asarray(road.heights, float)
    undone = (
        ("mm in place of m in coordinates", KEYS, place.in_mm(), z),
        ("mm in place of m in heights", frozenset({"heights"}), place, MM * z),
        ("mm in place of m in coordinates and heights", KEYS | {"heights"}, place.in_mm(), MM * z),
    )
    mistakes = [Mistake(words, keys, partial(road_values, road, p, h, start)) for words, keys, p, h in undone]
    if start is not None:
        mistakes += start_mistakes(place, start)
    return Echo(what, road_values(road, place, z, start), mistakes, title=TITLE)


def start_echo(what: str, place: Place, start: Start) -> Echo:
    """Whether a drive begins on a grid. `place`: of the grid; `start`: x and y where it begins, m."""
    mistakes, small = start_mistakes(place, start), place.in_mm()
    if min(small.extent) > 1.0:
        mistakes.insert(0, Mistake("mm in place of m in coordinates", KEYS, partial(_placed, small, start)))
    return Echo(what, _placed(place, start), mistakes, title=TITLE)


def _placed(place: Place, start: Start) -> list[Value]:
    return [*_sides(place), *_away(place, start)]


def start_mistakes(place: Place, start: Start) -> list[Mistake]:
    """Common mistakes by which a grid is not where a drive begins."""
    middle = [o + 0.5 * side for o, side in zip(place.origin, place.extent, strict=True)]
    map_words = f"coordinates of a map, of which {middle[0]:.0f}, {middle[1]:.0f} is to be taken"
    at_start = tuple(s - 0.5 * side for s, side in zip(start, place.extent, strict=True))
    return [
        Mistake(words, frozenset({"origin"}), partial(_away, replace(place, origin=origin), start))
        for words, origin in (("x and y exchanged in the origin", place.origin[::-1]), (map_words, at_start))
    ]


def _away(place: Place, start: Start) -> list[Value]:
    keys = place.keys | {"extent": place.extent, "start": list(start)}
    return [Value(QUANTITIES["away"], place.distance(start), keys)]


def _sides(place: Place) -> list[Value]:
    sides = zip("xy", place.extent, strict=True)
    return [Value(QUANTITIES["extent"], side, {"spacing": list(place.spacing)}, axis) for axis, side in sides]


def road_values(road: GridRoad, place: Place, z: np.ndarray, start: Start | None) -> list[Value]:
    """Values of all quantities of a grid. `place`, `z`: where it lies, its heights, m."""
    frictions, spacing = np.asarray(road.frictions, float), {"spacing": list(place.spacing)}
    heights = {"heights": [float(z.min()), float(z.max())]}
    steps = [float(np.abs(np.diff(z, axis=k)).max()) for k in range(2)]
    over = max(max(s - h for s, h in zip(steps, place.spacing, strict=True)), 0.0)
    return [
        *_sides(place),
        Value(QUANTITIES["heights"], float(np.ptp(z)), heights),
        Value(QUANTITIES["rise"], over, heights | spacing),
        Value(QUANTITIES["steepest"], max(s / h for s, h in zip(steps, place.spacing, strict=True))),
        Value(QUANTITIES["step"], height_step(z), heights),
        *_frictions(frictions.min() * road.friction_factor, frictions.max() * road.friction_factor),
        *([] if start is None else _away(place, start)),
    ]


def _plain_values(road: PlaneRoad | KerbRoad) -> list[Value]:
    friction = float(road.friction * road.friction_factor)
    steep = math.hypot(road.grade_x, road.grade_y) if isinstance(road, PlaneRoad) else 0.0
    step = road.step if isinstance(road, KerbRoad) else 0.0
    return [Value(QUANTITIES["rise"], step), Value(QUANTITIES["steepest"], steep), *_frictions(friction, friction)]


def _frictions(least: float, largest: float) -> list[Value]:
    ends = (("least", least), ("largest", largest))
    return [Value(QUANTITIES["friction"], float(value), {}, of) for of, value in ends]


def height_step(z: np.ndarray) -> float:
    """The step of which all heights are multiples, m; 0 where there is none that can be seen, as of a few levels."""
    levels = np.unique(z)
    if not FEWEST_LEVELS <= len(levels) <= MOST_LEVELS:
        return 0.0
    gaps = np.diff(levels)
    steps = gaps / gaps.min()
    # a few levels of a drawing have any differences; those of a coarse number type have neighbours everywhere
    whole = bool(np.all(np.abs(steps - np.round(steps)) < 1e-3 * np.round(steps)))
    return float(gaps.min()) if whole and float(np.median(steps)) < 1.5 else 0.0


@echo_of.register(PlaneRoad)
@echo_of.register(KerbRoad)
@echo_of.register(GridRoad)
def _echo_of_road(road: PlaneRoad | KerbRoad | GridRoad) -> list[Echo]:
    return [road_echo("", road)]


@echo_of.register
def file_echo(road: RoadFile, start: Start = (0.0, 0.0), most: float = MOST_POINTS) -> list[Echo]:
    """What was understood of a road of a file, and whether a drive begins on it.

    `start`: x and y, m; `most`: points; of a file with more its place alone is looked at.
    """
    head = None if Path(road.path).suffix.lower() in TEXTS else road.header
    if head is not None and head.nx * head.ny > most:
        return [start_echo(str(road.path), Place(head.real[:2], head.real[2:4], (head.nx, head.ny)), start)]
    return [road_echo(str(road.path), read_road(road.path), start)]
