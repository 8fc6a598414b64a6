"""Files that the description of a world or a road names."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ali3.reading import is_file, read_toml
from mbs.roads.road_header import RoadFileError


def is_world(table: Mapping[str, Any]) -> bool:
    """Whether the content of a TOML file describes a world, not a road."""
    return table.get("kind") == "world"


def named_files(file: Path) -> tuple[str, list[Path]]:
    """Name of a world or road, and the existing files that its description names."""
    table = read_toml(file, RoadFileError)
    entries = []
    if is_world(table):
        ground = table.get("ground")
        courses = table.get("courses")
        entries = [ground.get("heights")] if isinstance(ground, dict) else []
        entries += [c.get("points") for c in courses if isinstance(c, dict)] if isinstance(courses, list) else []
    else:
        entries = [table.get("heights"), table.get("frictions")]
    name = table.get("name") if is_world(table) else None
    paths = [file.parent / item for item in entries if isinstance(item, str)]
    return name if isinstance(name, str) else file.stem, [path for path in paths if is_file(path)]
