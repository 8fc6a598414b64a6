"""The cones of a course, as a scene draws them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ali3.cones import cone_places
from hosts.driving.course import Course


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
        The scene with cones in its scenery; where the height of its road is not known in closed form they stand in
        `missing` instead.
    """
    places = cone_places(course.gates)
    heights = [_height(scene.get("roads", []), x, y) for x, y in places]
    if not np.all(np.isfinite(heights)):
        why = "they are put onto level roads, planes and kerbs only"
        return dict(scene) | {"missing": [*scene.get("missing", []), {"name": f"cones of {course.name}", "why": why}]}
    cones = [{"kind": "cone", "at": [x, y, z]} for (x, y), z in zip(places, heights, strict=True)]
    return dict(scene) | {"scenery": [*scene.get("scenery", []), *cones]}


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
        else:
            return math.nan
    return found
