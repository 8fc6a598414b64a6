"""JSON file of a world: its scene and its start positions."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from ali3.scene.base64_numbers import encoded, encoded_octets
from mbs.worlds.patches import BOUND, DrawnPatch, make_patches
from mbs.worlds.profiles import equidistant
from mbs.worlds.scenery import scenery_of
from mbs.worlds.terrain import Terrain

FORMAT, VERSION = "ALi3 world", 1
MAX_CELLS = 1_500_000
"""Largest number of cells of the map of surfaces."""
MIN_CELL = 0.25


def world_record(
    terrain: Terrain, tell: Callable[[float], None] = lambda fraction: None, step: float = 0.0
) -> dict[str, Any]:
    """Content of the JSON file of a world.

    `tell`: function of the completed fraction, 0 to 1; `step`: step of the drawn heights, m; 0: they
    are not rounded.
    """
    world = terrain.world
    patches = make_patches(terrain, lambda fraction: tell(0.9 * fraction))
    road = {
        "kind": "terrain",
        "patches": [_patch_entry(patch, step) for patch in patches],
        "surface": _surface_entry(terrain),
        "note": f"Drawn within {1e3 * BOUND:g} mm of what the wheels feel; scenery is only seen.",
    }
    return make_record(
        world.name,
        world.bounds,
        [place.model_dump(exclude={"at"}) | _pose(place.at) for place in world.places],
        [road],
        scenery_of(terrain),
        world.description,
    )


def make_record(
    name: str,
    bounds: tuple[float, float, float, float],
    places: list[dict[str, Any]],
    roads: list[dict[str, Any]],
    scenery: list[dict[str, Any]],
    description: str = "",
) -> dict[str, Any]:
    """Content of the JSON file of a world from its parts."""
    start = {"name": "start", "text": "the origin", "x": 0.0, "y": 0.0, "yaw": 0.0}
    return {
        "format": FORMAT,
        "version": VERSION,
        "name": name,
        "description": description,
        "road": f"{name}.road",
        "bounds": list(bounds),
        "places": places or [start],
        "roads": roads,
        "scenery": scenery,
    }


def _pose(at: tuple[float, float, float]) -> dict[str, float]:
    """Entries of a start position from x, y, m, and yaw, degrees."""
    return {"x": at[0], "y": at[1], "yaw": math.radians(at[2])}


def _patch_entry(patch: DrawnPatch, step: float) -> dict[str, Any]:
    """Scene entry of a patch, with heights rounded to multiples of `step`, m, if it is not 0."""
    heights = patch.heights if step == 0.0 else step * np.round(patch.heights / step)
    return {
        "origin": [patch.x, patch.y],
        "spacing": [patch.dx, patch.dy],
        "shape": list(patch.heights.shape),
        "heights": encoded(heights),
    }


def _surface_entry(terrain: Terrain) -> dict[str, Any]:
    """Scene entry of the surfaces: their indices on a grid of cells, their names and frictions."""
    x0, y0, x1, y1 = terrain.world.bounds
    step = max(MIN_CELL, math.sqrt((x1 - x0) * (y1 - y0) / MAX_CELLS))
    n = [max(2, math.ceil(side / step)) for side in (x1 - x0, y1 - y0)]
    cell = [(x1 - x0) / n[0], (y1 - y0) / n[1]]
    x, y = equidistant(x0 + 0.5 * cell[0], cell[0], n[0]), equidistant(y0 + 0.5 * cell[1], cell[1], n[1])
    _, classes, _ = terrain.on_grid(x, y)
    return {
        "origin": [float(x[0]), float(y[0])],
        "spacing": cell,
        "shape": n,
        "classes": encoded_octets(classes),
        "names": list(terrain.names),
        "frictions": [float(value) for value in terrain.frictions],
    }
