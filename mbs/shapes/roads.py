"""Roads of a model as what draws reads them."""

from __future__ import annotations

from typing import Any

from mbs.elements.road import PortRoad
from mbs.model.model import Model
from mbs.roads.scene_part import scene_part


def roads_of(model: Model) -> list[dict[str, Any]]:
    """Roads, and the level planes on which wheels roll without slip; a road from a file is named only."""
    files = {file.road: file for file in model.road_files if file.start}
    found: list[dict[str, Any]] = []
    for k, road in enumerate(model.roads):
        if isinstance(road, PortRoad):
            continue  # only the program that answers knows it
        file = files.get(k)
        found.append(scene_part(road) if file is None else {"kind": "file", "variable": file.name, "path": file.start})
    levels = sorted({joint.rolls.level for joint in model.joints if joint.rolls is not None})
    return found + [{"kind": "flat", "height": level} for level in levels]
