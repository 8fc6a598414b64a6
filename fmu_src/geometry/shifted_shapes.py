"""Coordinates of shapes transformed to frames with another origin."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from fmu_src.geometry.sensor_rows import Array


def moved_part(part: Mapping[str, Any], moved: Mapping[str, Array]) -> dict[str, Any]:
    """A shape, arrow or flexible part in frames with other origins.

    `moved`, shape (3,): place of the old origin in the new frame, m, by frame.
    """
    shifted = dict(part)
    frame = part.get("frame")
    if frame is not None:
        shift = moved.get(frame)
        if shift is None:
            return shifted
        if part.get("kind") == "cylinder":
            shifted["ends"] = [_shifted_point(point, shift) for point in part["ends"]]
        elif "nodes" in part:
            shifted["nodes"] = [_shifted_point(point, shift) for point in part["nodes"]]
        else:
            shifted["at"] = _shifted_point(part.get("at", (0.0, 0.0, 0.0)), shift)
        return shifted
    for key in ("points", "ends", "between"):
        if key in part:
            shifted[key] = [_shifted_anchor(anchor, moved) for anchor in part[key]]
    if "vector" in part:
        shifted["at"] = _shifted_anchor(part["at"], moved)
    return shifted


def _shifted_anchor(anchor: Any, moved: Mapping[str, Array]) -> list[Any]:
    name, point = anchor
    return [name, _shifted_point(point, moved[name]) if name in moved else list(point)]


def _shifted_point(place: Any, shift: Array) -> list[float]:
    return [float(x) + 0.0 for x in np.asarray(place, float) + shift]
