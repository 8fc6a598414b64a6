"""What a manoeuvre has on the ground, as a scene draws it: on the heights of its roads."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import astuple
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ali3.cones import cone_places
from ali3.iso_3888 import Gate
from hosts.driving.course import Course
from hosts.driving.ground_marks import Mark, lanes
from viewer.base64_numbers import decoded

_WIDTH = 0.15  # m, of lines
_FEWEST, _MOST = 72, 3600  # sections of a circle; between them one a metre


def with_course(scene: Mapping[str, Any], course: Course) -> dict[str, Any]:
    """A scene with the cones of a course that a driver follows, on its roads.

    Parameters
    ----------
    scene : mapping
        Roads with the values that were set.
    course : Course
        In earth axes.

    Returns
    -------
    dict
        The scene with cones in its scenery; where the height of its road is not known they stand in `missing` instead.
    """
    return with_marks(
        scene, [lanes([astuple(gate) for gate in course.gates], (0.0, 0.0, 0.0))], f"cones of {course.name}"
    )


def with_marks(scene: Mapping[str, Any], marks: Sequence[Mark], name: str) -> dict[str, Any]:
    """A scene with marks on its roads; `name` is that of `missing` where they cannot be put there."""

    def placed(x: float, y: float) -> list[float]:
        return [x, y, _height(scene.get("roads", []), x, y)]

    things = [
        thing | ({"at": placed(*thing["at"])} if "at" in thing else {"points": [placed(*p) for p in thing["points"]]})
        for thing in things_of(marks)
    ]
    places = [place for thing in things for place in ([thing["at"]] if "at" in thing else thing["points"])]
    if not np.all(np.isfinite(places)):
        why = "they are put onto level roads, planes, kerbs and within grids of heights only"
        return dict(scene) | {"missing": [*scene.get("missing", []), {"name": name, "why": why}]}
    return dict(scene) | ({"scenery": [*scene.get("scenery", []), *things]} if things else {})


def things_of(marks: Sequence[Mark]) -> list[Mark]:
    """Cones and lines, of which scenes are made, for marks.

    Raises
    ------
    ValueError, KeyError, TypeError, OverflowError
        They are no marks.
    """
    things = []
    for mark in marks:
        if mark["kind"] == "circle":
            (x, y), radius = mark["centre"], mark["radius"]
            sections = min(max(_FEWEST, math.ceil(2.0 * math.pi * radius)), _MOST)
            angles = np.linspace(0.0, 2.0 * math.pi, sections + 1)
            points = np.column_stack([x + radius * np.cos(angles), y + radius * np.sin(angles)]).tolist()
            things.append({"kind": "line", "points": points, "width": _WIDTH})
        elif mark["kind"] == "line":
            points = [[float(x), float(y)] for x, y in mark["points"]]
            things.append({"kind": "line", "points": points, "width": _WIDTH, "colour": mark["colour"]})
        elif mark["kind"] == "lanes":
            x0, y0, yaw = mark["pose"]
            c, s = math.cos(yaw), math.sin(yaw)
            places = cone_places([Gate(*gate) for gate in mark["gates"]])
            things += [{"kind": "cone", "at": [x0 + c * x - s * y, y0 + s * x + c * y]} for x, y in places]
        else:
            raise ValueError(mark["kind"])
    return things


def _height(roads: Sequence[Mapping[str, Any]], x: float, y: float) -> float:
    """Height of the roads at a place, m; NaN where that takes more than a formula."""
    found = 0.0
    for road in roads:
        if road["kind"] == "flat":
            found = float(road.get("height", 0.0))
        elif road["kind"] == "plane":
            (px, py, pz), (nx, ny, nz) = road["point"], road["normal"]
            found = pz - (nx * (x - px) + ny * (y - py)) / nz
        elif road["kind"] == "profile":
            (ox, oy, oz), (dx, dy, _) = road.get("origin", (0.0, 0.0, 0.0)), road.get("direction", (1.0, 0.0, 0.0))
            along = ((x - ox) * dx + (y - oy) * dy) / math.hypot(dx, dy)
            found = oz + float(np.interp(along, road["stations"], road["heights"]))
        elif road["kind"] == "grid" and road.get("axes") is None:
            found = _height_of_grid(road, x, y)
        else:
            return math.nan
    return found


def _height_of_grid(road: Mapping[str, Any], x: float, y: float) -> float:
    """Linear along both axes between four points of the grid, m; NaN beside it."""
    nx, ny = road["shape"]
    i, j = ((value - start) / step for value, start, step in zip((x, y), road["origin"], road["spacing"], strict=True))
    if not (0.0 <= i <= nx - 1 and 0.0 <= j <= ny - 1):
        return math.nan
    heights = _heights_of_grid(road["heights"]).reshape(nx, ny)
    a, b = min(int(i), nx - 2), min(int(j), ny - 2)
    along = heights[a : a + 2, b : b + 2] @ [1.0 - (j - b), j - b]
    return float(along @ [1.0 - (i - a), i - a])


@lru_cache(maxsize=4)
def _heights_of_grid(text: str) -> NDArray[Any]:
    return decoded(text, "f")
