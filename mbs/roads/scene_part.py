"""Entry of a road in the list `roads` of a scene, which can be drawn without the road file."""

import math
import os
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ali3.reading import LARGEST_IN_PARTS, open_file
from ali3.scene.base64_numbers import encoded
from mbs.elements.road import GridRoad, KerbRoad, PlaneRoad
from mbs.kernel.header.limits import ROAD_SHARED, ROAD_TILE
from mbs.roads.read_road import read_road
from mbs.roads.road_file import RoadFile
from mbs.roads.road_header import RoadFileError
from mbs.roads.shared_tiles import read_shared

MAX_READ_POINTS = 4_000_000
"""Largest number of points of a road file that are read to draw it."""
MAX_DRAWN_POINTS = 400
"""Largest number along a side of a drawn grid; a larger grid is thinned."""
MIN_HALF_WIDTH = 10.0  # m, of a drawn level grid with several frictions: those at its border continue
KERB_LENGTH = 1e-3  # m, of the drawn step of a kerb


def scene_part(road: PlaneRoad | KerbRoad | GridRoad) -> dict[str, Any]:
    """Entry of the list `roads` of a scene for a road: flat, plane, profile or grid."""
    if isinstance(road, PlaneRoad):
        return _plane_entry(road) | _friction_entries(road.friction, road.friction_factor)
    if isinstance(road, KerbRoad):
        return _kerb_entry(road) | _friction_entries(road.friction, road.friction_factor)
    return _grid_entry(road)


def _friction_entries(friction: float | None, factor: float) -> dict[str, Any]:
    """Entries of a road's friction in the scene. `friction`: None if it varies over the road."""
    friction_entry = {} if friction is None else {"friction": friction}
    return friction_entry if factor == 1.0 else friction_entry | {"friction_factor": factor}


def read_thinned(file: str | os.PathLike[str]) -> PlaneRoad | KerbRoad | GridRoad:
    """Read a road file; of a large grid with shared tiles only every n-th point in x and y."""
    road_file = RoadFile(file)
    head = road_file.header
    stride = max(1, math.isqrt(head.nx * head.ny // MAX_READ_POINTS))
    if head.version != ROAD_SHARED or stride == 1:
        return road_file.read()
    x, y = np.arange(0, head.nx, stride), np.arange(0, head.ny, stride)
    values = np.zeros((head.maps, len(x), len(y)))
    with open_file(file, LARGEST_IN_PARTS, RoadFileError) as opened:
        for number, tile in read_shared(opened, head, file):
            i, j = (number // head.tiles[1]) * ROAD_TILE, (number % head.tiles[1]) * ROAD_TILE
            rows, columns = (np.arange(*np.searchsorted(v, (k, k + ROAD_TILE))) for v, k in ((x, i), (y, j)))
            values[:, rows[:, None], columns] = tile[:, x[rows, None] - i, y[columns] - j]
    spacing = (head.real[2] * stride, head.real[3] * stride)
    return GridRoad(head.real[:2], spacing, values[0], values[1] if head.maps == 2 else head.real[4])


def drawn_roads(roads: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Roads of a scene, with the content of files instead of their paths, which are paths of this machine.

    Raises `RoadFileError` if a file cannot be read.
    """
    return [
        scene_part(read_road(road["path"])) if road["kind"] == "file" and road.get("path") else dict(road)
        for road in roads
    ]


def _plane_entry(road: PlaneRoad) -> dict[str, Any]:
    """Entry of a plane in the scene."""
    if road.grade_x == 0.0 and road.grade_y == 0.0:
        return {"kind": "flat", "height": float(road.height)}
    normal = np.array([-road.grade_x, -road.grade_y, 1.0])
    unit = [float(x) + 0.0 for x in normal / np.linalg.norm(normal)]
    return {"kind": "plane", "point": [0.0, 0.0, float(road.height)], "normal": unit}


def _kerb_entry(road: KerbRoad) -> dict[str, Any]:
    """Entry of a kerb in the scene: a profile over a limited length."""
    low, high = float(road.lower_height), float(road.lower_height + road.step)
    before, after = (high, low) if road.upper == "before" else (low, high)
    return {
        "kind": "profile",
        "stations": [-0.5 * KERB_LENGTH, 0.5 * KERB_LENGTH],
        "heights": [before, after],
        "direction": [1.0, 0.0, 0.0],
        "origin": [float(road.position), 0.0, 0.0],
    }


def _grid_entry(road: GridRoad) -> dict[str, Any]:
    """Entry of a grid in the scene, with a limited number of points."""
    heights = np.asarray(road.heights, float)
    frictions = np.broadcast_to(np.asarray(road.frictions, float), heights.shape)
    origin = np.array(road.origin, float)
    if heights.min() == heights.max() and frictions.min() != frictions.max():
        shortfall = MIN_HALF_WIDTH - 0.5 * (np.array(heights.shape) - 1) * road.spacing
        padding = np.maximum(np.ceil(shortfall / road.spacing), 0).astype(int)
        heights, frictions = (np.pad(values, [(n, n) for n in padding], mode="edge") for values in (heights, frictions))
        origin -= padding * np.array(road.spacing, float)
    strides = [max(1, -(-(n - 1) // (MAX_DRAWN_POINTS - 1))) for n in heights.shape]
    slices = tuple(slice(None, None, k) for k in strides)
    grid = heights[slices]
    entry: dict[str, Any] = {
        "kind": "grid",
        "origin": [float(x) for x in origin],
        "spacing": [float(d) * k for d, k in zip(road.spacing, strides, strict=True)],
        "shape": list(grid.shape),
        "heights": encoded(grid),
    }
    uniform = frictions.min() == frictions.max()
    entry |= _friction_entries(float(frictions[0, 0]) if uniform else None, road.friction_factor)
    if not uniform:
        entry["frictions"] = encoded(frictions[slices])
    if max(strides) > 1:
        entry["note"] = (
            f"the road has {heights.shape[0]} x {heights.shape[1]} points; {grid.shape[0]} x {grid.shape[1]} of them "
            "are drawn"
        )
    return entry
