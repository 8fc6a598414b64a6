"""Roads of a model as what draws reads them."""

from typing import Any

from mbs.elements.road import PortRoad
from mbs.model.model import Model
from mbs.roads.scene_part import scene_part


def roads_of(model: Model) -> list[dict[str, Any]]:
    """Roads, and the level planes on which wheels roll without slip; a road from a file is named only.

    Where a road at ports is left out, those behind it keep their numbers.
    """
    files = {file.road: file for file in model.road_files if file.start}
    found: list[tuple[int, dict[str, Any]]] = []
    for k, road in enumerate(model.roads):
        if isinstance(road, PortRoad):
            continue  # only the program that answers knows it
        file = files.get(k)
        part = scene_part(road) if file is None else {"kind": "file", "variable": file.name, "path": file.start}
        found.append((k, part))
    levels = sorted({joint.rolls.level for joint in model.joints if joint.rolls is not None})
    found += [(k, {"kind": "flat", "height": level}) for k, level in enumerate(levels, len(model.roads))]
    return [part if k == place else part | {"number": k} for place, (k, part) in enumerate(found)]
