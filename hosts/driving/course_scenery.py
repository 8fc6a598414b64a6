"""Adds the ground marks and cones of a manoeuvre to a scene, at the heights of its roads."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import astuple
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ali3.cones import cone_places
from ali3.iso_3888 import Gate
from ali3.scene.base64_numbers import decoded
from hosts.driving.course import Course
from hosts.driving.ground_marks import Mark, lanes
from viewer.looks import LOOKS

Array = NDArray[np.float64]

_LINE_WIDTH = 0.15  # m, of lines
# Limits of the number of sections of a circle, which are 1 m long in between.
_LEAST_SECTIONS = 72
_MOST_SECTIONS = 3600


def with_course(scene: Mapping[str, Any], course: Course) -> dict[str, Any]:
    """A scene with the cones of a course that a driver follows, on its roads.

    `scene`: with settings applied to its roads; `course`: in earth axes. Returns the scene with cones in its scenery,
    or with an entry in `missing` if the height of its road is not known.
    """
    return with_marks(
        scene, [lanes([astuple(gate) for gate in course.gates], (0.0, 0.0, 0.0))], f"cones of {course.name}"
    )


def with_marks(scene: Mapping[str, Any], marks: Sequence[Mark], name: str) -> dict[str, Any]:
    """A scene with marks on its roads. `name`: of the entry in `missing`, if heights are unknown."""
    scenery = scenery_of(marks)
    flat = np.array([p for entry in scenery for p in entry.get("points", [entry.get("at")])], float).reshape(-1, 2)
    points = np.column_stack([flat, _heights(scene.get("roads", []), *flat.T)])
    if not np.all(np.isfinite(points)):
        reason = "they are put onto level roads, planes, kerbs and within grids of heights and terrains only"
        return dict(scene) | {"missing": [*scene.get("missing", []), {"name": name, "why": reason}]}
    positions = iter(points.tolist())
    scenery = [
        entry | ({"at": next(positions)} if "at" in entry else {"points": [next(positions) for _ in entry["points"]]})
        for entry in scenery
    ]
    return dict(scene) | ({"scenery": [*scene.get("scenery", []), *scenery]} if scenery else {})


def scenery_of(marks: Sequence[Mark]) -> list[Mark]:
    """The cones and lines of a scenery that draw marks.

    Raises `ValueError`, `KeyError`, `TypeError` or `OverflowError`: the marks are not valid.
    """
    scenery = []
    for mark in marks:
        if mark["kind"] == "circle":
            (x, y), radius = mark["centre"], mark["radius"]
            sections = min(max(_LEAST_SECTIONS, math.ceil(2.0 * math.pi * radius)), _MOST_SECTIONS)
            angles = np.linspace(0.0, 2.0 * math.pi, sections + 1)
            points = np.column_stack([x + radius * np.cos(angles), y + radius * np.sin(angles)]).tolist()
            scenery.append({"kind": "line", "points": points, "width": _LINE_WIDTH})
        elif mark["kind"] == "line":
            points = [[float(x), float(y)] for x, y in mark["points"]]
            scenery.append({"kind": "line", "points": points, "width": _LINE_WIDTH, "colour": mark["colour"]})
        elif mark["kind"] == "lanes":
            x0, y0, yaw = mark["pose"]
            c, s = math.cos(yaw), math.sin(yaw)
            positions = cone_places([Gate(*gate) for gate in mark["gates"]])
            scenery += [{"kind": "cone", "at": [x0 + c * x - s * y, y0 + s * x + c * y]} for x, y in positions]
        else:
            raise ValueError(mark["kind"])
    return scenery


def _heights(roads: Sequence[Mapping[str, Any]], x: Array, y: Array) -> Array:
    """Heights of the roads at n points, m; NaN on roads that are not supported."""
    values = np.zeros(len(x))
    for road in roads:
        if road["kind"] == "flat":
            values = np.full(len(x), float(road.get("height", 0.0)))
        elif road["kind"] == "plane":
            (px, py, pz), (nx, ny, nz) = road["point"], road["normal"]
            values = pz - (nx * (x - px) + ny * (y - py)) / nz
        elif road["kind"] == "profile":
            (ox, oy, oz), (dx, dy, _) = road.get("origin", (0.0, 0.0, 0.0)), road.get("direction", (1.0, 0.0, 0.0))
            along = ((x - ox) * dx + (y - oy) * dy) / math.hypot(dx, dy)
            values = oz + np.interp(along, road["stations"], road["heights"])
        elif road["kind"] == "grid" and road.get("axes") is None:
            values = _heights_of_grid(road, x, y, LOOKS["border"])
        elif road["kind"] == "terrain":
            values = np.full(len(x), math.nan)
            for patch in road["patches"]:
                values = np.where(np.isnan(values), _heights_of_grid(patch, x, y, 0.0), values)
        else:
            return np.full(len(x), math.nan)
    return values


def _heights_of_grid(road: Mapping[str, Any], x: Array, y: Array, border: float) -> Array:
    """Bilinear heights of a grid, m; beyond it those of its edge, and NaN farther than `border`, m."""
    nx, ny = road["shape"]
    i, j = ((value - start) / step for value, start, step in zip((x, y), road["origin"], road["spacing"], strict=True))
    inside = np.clip(i, 0, nx - 1), np.clip(j, 0, ny - 1)
    distance = np.maximum(
        *(np.abs(k - limit) * step for k, limit, step in zip((i, j), inside, road["spacing"], strict=True))
    )
    i, j = inside
    heights = decoded(road["heights"], "f").reshape(nx, ny)
    a, b = np.minimum(i.astype(int), nx - 2), np.minimum(j.astype(int), ny - 2)
    u, v = i - a, j - b
    lower, upper = (heights[k, b] * (1.0 - v) + heights[k, b + 1] * v for k in (a, a + 1))
    return np.where(distance <= border, lower * (1.0 - u) + upper * u, math.nan)
