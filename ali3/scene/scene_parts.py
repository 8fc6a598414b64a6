"""Finds the frames that the parts of a scene are attached to."""

from collections.abc import Mapping
from typing import Any

GROUND = "ground"


def anchors_of(shape: Mapping[str, Any]) -> list[Any]:
    """Points of frames that a shape or an arrow is attached to."""
    if "frame" in shape:
        return []
    anchors = shape.get("points") or shape.get("ends") or shape.get("between") or []
    return [*anchors, *([shape["at"]] if shape.get("vector") else [])]


def frames_of(part: Mapping[str, Any]) -> list[str]:
    """Frames that a shape, an arrow, a flexible part or a frame depends on."""
    frames = [part[key] for key in ("frame", "parent", "axes") if isinstance(part.get(key), str)]
    anchors = part["on"] if "on" in part else anchors_of(part)
    return [*frames, *(anchor[0] for anchor in anchors)]
