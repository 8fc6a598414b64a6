"""Coordinates of shapes transformed to frames with another origin."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from fmu_src.geometry.sensor_rows import Array


def moved_part(part: Mapping[str, Any], moved: Mapping[str, Array]) -> dict[str, Any]:
    """A shape, arrow or flexible part in frames whose origins were moved.

    `moved`, shape (3,): place of the old origin in the new frame, m, by frame.
    """
    found = dict(part)
    frame = part.get("frame")
    if frame is not None:
        shift = moved.get(frame)
        if shift is None:
            return found
        if part.get("kind") == "cylinder":
            found["ends"] = [_plus(place, shift) for place in part["ends"]]
        elif "nodes" in part:
            found["nodes"] = [_plus(place, shift) for place in part["nodes"]]
        else:
            found["at"] = _plus(part.get("at", (0.0, 0.0, 0.0)), shift)
        return found
    for key in ("points", "ends", "between"):
        if key in part:
            found[key] = [_anchor(anchor, moved) for anchor in part[key]]
    if "vector" in part:
        found["at"] = _anchor(part["at"], moved)
    return found


def _anchor(anchor: Any, moved: Mapping[str, Array]) -> list[Any]:
    name, place = anchor
    return [name, _plus(place, moved[name]) if name in moved else list(place)]


def _plus(place: Any, shift: Array) -> list[float]:
    return [float(x) + 0.0 for x in np.asarray(place, float) + shift]
