"""Entries of a scene for the roads of a model."""

from typing import Any

from mbs.elements.road import PortRoad
from mbs.model.model import Model
from mbs.roads.scene_part import scene_part


def road_entries(model: Model) -> list[dict[str, Any]]:
    """Entries of all roads, and of the level planes on which wheels roll without slip.

    A road file is entered by its path. A road at a port is left out because only the host knows its heights; the roads
    after it keep their numbers.
    """
    # without a path the road of the model is used
    files_by_road = {file.road: file for file in model.road_files if file.start}
    entries: list[tuple[int, dict[str, Any]]] = []
    for number, road in enumerate(model.roads):
        if isinstance(road, PortRoad):
            continue
        file = files_by_road.get(number)
        entry = scene_part(road) if file is None else {"kind": "file", "variable": file.name, "path": file.start}
        entries.append((number, entry))
    plane_levels = sorted({joint.rolls.level for joint in model.joints if joint.rolls is not None})
    for number, level in enumerate(plane_levels, len(model.roads)):
        entries.append((number, {"kind": "flat", "height": level}))
    # an entry without a number has the number of its position
    return [
        entry if number == position else entry | {"number": number} for position, (number, entry) in enumerate(entries)
    ]
