"""What was understood of a road of points: where it lies, how high and steep it is, and whether a start is on it."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from ali3.echo import Echo, Mistake, Value, quantities_of
from mbs.elements.road import GridRoad

MOST_LEVELS, FEWEST_LEVELS = 4096, 5
MM = 1e-3
UNITS = {MM: "mm", 1e-2: "cm", 0.0254: "inches", 0.3048: "feet", 1e3: "km"}
"""What is taken for m, by its length in m."""
KEYS = ("spacing", "heights")
QUANTITIES = quantities_of("road")


def road_echo(what: str, road: GridRoad) -> Echo:
    """What was understood of a grid. `what`: the file."""
    mistakes = []
    for keys, of in ((KEYS[:1], "coordinates"), (KEYS[1:], "heights"), (KEYS, "coordinates and heights")):
        for factor, unit in UNITS.items():
            change: dict[str, Any] = {key: factor * np.asarray(getattr(road, key), float) for key in keys}
            changed = replace(_plain(road), **change)
            mistakes.append(Mistake(f"{unit} in place of m in {of}", frozenset(keys), partial(road_values, changed)))
    z, frictions = np.asarray(road.heights, float), np.asarray(road.frictions, float)
    if 0 < (none := z == z.min()).sum() < z.size:
        filled = replace(_plain(road), heights=np.where(none, z[~none].min(), z))
        words = f"{z.min():g} in the place of no value in heights"
        mistakes.append(Mistake(words, frozenset(KEYS[1:]), partial(road_values, filled)))
    parts = partial(road_values, replace(_plain(road), frictions=0.01 * frictions))
    mistakes.append(Mistake("percent in place of a ratio in frictions", frozenset({"frictions"}), parts))
    return Echo(what, road_values(road), mistakes)


def start_echo(what: str, place: Place, start: tuple[float, float]) -> Echo:
    """Whether a drive begins on a grid. `place`: of the grid; `start`: x and y where it begins, m."""

    def values(place: Place) -> list[Value]:
        keys = {"origin": list(place.origin), "extent": place.extent, "start": list(start)}
        return [Value(QUANTITIES["away"], place.distance(start), keys)]

    middle = [o + 0.5 * side for o, side in zip(place.origin, place.extent, strict=True)]
    at_start = [s - 0.5 * side for s, side in zip(start, place.extent, strict=True)]
    small = Place(
        (MM * place.origin[0], MM * place.origin[1]), (MM * place.spacing[0], MM * place.spacing[1]), place.shape
    )
    mistakes = [
        Mistake(words, frozenset({"origin"}), partial(values, undone))
        for words, undone in (
            ("mm in place of m in coordinates", small),
            ("x and y exchanged in the origin", replace(place, origin=place.origin[::-1])),
            (
                f"coordinates of a map or another origin, of which {middle[0]:.0f}, {middle[1]:.0f} is to be taken",
                replace(place, origin=tuple(at_start)),
            ),
        )
        if undone is not small or min(small.extent) > 1.0
    ]
    return Echo(what, values(place), mistakes)


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

    def distance(self, point: tuple[float, float]) -> float:
        """From a point to its rectangle, m; 0 within."""
        ends = zip(point, self.origin, self.extent, strict=True)
        return math.hypot(*(max(low - p, p - low - side, 0.0) for p, low, side in ends))


def place_of(road: GridRoad) -> Place:
    """Where a grid lies."""
    origin, spacing = (tuple(map(float, pair)) for pair in (road.origin, road.spacing))
    return Place(origin, spacing, np.shape(road.heights))


def road_values(road: GridRoad) -> list[Value]:
    """Values of all quantities of a grid."""
    z, frictions = np.asarray(road.heights, float), np.asarray(road.frictions, float)
    spacing, heights = {"spacing": list(map(float, road.spacing))}, {"heights": [float(z.min()), float(z.max())]}
    sides = zip("xy", place_of(road).extent, strict=True)
    found = [Value(QUANTITIES["extent"], side, spacing, axis) for axis, side in sides]
    found.append(Value(QUANTITIES["heights"], float(np.ptp(z)), heights))
    found.append(Value(QUANTITIES["spacing"], float(min(road.spacing)), spacing, "least"))
    steps = [float(np.abs(np.diff(z, axis=k)).max()) for k in range(2)]
    over = max(max(s - h for s, h in zip(steps, road.spacing, strict=True)), 0.0)
    found.append(Value(QUANTITIES["rise"], over, heights | spacing))
    found.append(Value(QUANTITIES["steepest"], max(s / h for s, h in zip(steps, road.spacing, strict=True))))
    found.append(Value(QUANTITIES["step"], height_step(z), {"number type of heights": height_step(z)}))
    ends = (("least", frictions.min()), ("largest", frictions.max()))
    keys = {"frictions": [float(frictions.min()), float(frictions.max())], "friction_factor": road.friction_factor}
    return [*found, *(Value(QUANTITIES["friction"], float(v) * road.friction_factor, keys, of) for of, v in ends)]


def _plain(road: GridRoad) -> GridRoad:
    return GridRoad(road.origin, road.spacing, road.heights, road.frictions, road.friction_factor)


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
