"""Entries of a scene for the roads of a model."""

from typing import Any

from mbs.elements.road import PortRoad
from mbs.model.model import Model
from mbs.roads.scene_part import scene_part


def roads_of(model: Model) -> list[dict[str, Any]]:
    """Entries of all roads, and of the level planes on which wheels roll without slip.

    The entry of a road file is its path. A road at ports is omitted, as only the program at the port knows it; the
    following roads keep their numbers.
    """
    files = {file.road: file for file in model.road_files if file.start}
    parts: list[tuple[int, dict[str, Any]]] = []
    for k, road in enumerate(model.roads):
        if isinstance(road, PortRoad):
            continue
        file = files.get(k)
        road_part = scene_part(road) if file is None else {"kind": "file", "variable": file.name, "path": file.start}
        parts.append((k, road_part))
    plane_levels = sorted({joint.rolls.level for joint in model.joints if joint.rolls is not None})
    parts += [(k, {"kind": "flat", "height": level}) for k, level in enumerate(plane_levels, len(model.roads))]
    return [road_part if k == position else road_part | {"number": k} for position, (k, road_part) in enumerate(parts)]
