"""Roads of a model as what draws reads them."""

from __future__ import annotations

import base64
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from mbs.elements.road import GridRoad, KerbRoad, PlaneRoad
from mbs.model.model import Model
from mbs.shapes.frames import numbers

EDGE = 1e-3  # m, along which the step of a kerb is drawn


def base64_of(values: ArrayLike, kind: str = "<f4") -> str:
    """Numbers as base64 of little-endian float32 or, with ``<u4``, uint32."""
    return base64.b64encode(np.ascontiguousarray(values, dtype=kind).tobytes()).decode()


def roads_of(model: Model) -> list[dict[str, Any]]:
    """Roads, and the level planes on which wheels roll without slip."""
    found: list[dict[str, Any]] = []
    for road in model.roads:
        if isinstance(road, PlaneRoad):
            found.append(_plane(road))
        elif isinstance(road, KerbRoad):
            found.append(_kerb(road))
        else:
            found.append(_grid(road))
    levels = sorted({joint.rolls.level for joint in model.joints if joint.rolls is not None})
    return found + [{"kind": "flat", "height": level} for level in levels]


def _plane(road: PlaneRoad) -> dict[str, Any]:
    if road.grade_x == 0.0 and road.grade_y == 0.0:
        return {"kind": "flat", "height": float(road.height)}
    normal = np.array([-road.grade_x, -road.grade_y, 1.0])
    return {
        "kind": "plane",
        "point": [0.0, 0.0, float(road.height)],
        "normal": numbers(normal / np.linalg.norm(normal)),
    }


def _kerb(road: KerbRoad) -> dict[str, Any]:
    low, high = float(road.lower_height), float(road.lower_height + road.step)
    before, after = (high, low) if road.upper == "before" else (low, high)
    return {
        "kind": "profile",
        "stations": [-0.5 * EDGE, 0.5 * EDGE],
        "heights": [before, after],
        "direction": [1.0, 0.0, 0.0],
        "origin": [float(road.position), 0.0, 0.0],
    }


def _grid(road: GridRoad) -> dict[str, Any]:
    heights = np.asarray(road.heights, float)
    frictions = np.broadcast_to(np.asarray(road.frictions, float), heights.shape)
    found = {
        "kind": "grid",
        "origin": numbers(road.origin),
        "spacing": numbers(road.spacing),
        "shape": list(heights.shape),
        "heights": base64_of(heights),
    }
    return found if frictions.min() == frictions.max() else found | {"frictions": base64_of(frictions)}
