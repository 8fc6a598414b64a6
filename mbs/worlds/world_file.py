"""Files that a world or a road names."""

from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any
from urllib.parse import unquote

from ali3.json_reading import read_json
from ali3.reading import is_file, read_toml
from mbs.roads.road_header import RoadFileError


def is_world(table: Mapping[str, Any]) -> bool:
    """Whether the content of a TOML file describes a world, not a road."""
    return table.get("kind") == "world"


def named_files(file: Path) -> tuple[str, list[Path]]:
    """Name of a world or road, and the existing files that it is made from, without `file`.

    They are those that its description names, and the buffers of a glTF file.
    """
    kind, name = file.suffix.lower(), None
    entries: list[Any] = []
    if kind == ".gltf":
        entries = _buffers(file)
    elif kind == ".toml":
        table = read_toml(file, RoadFileError)
        if is_world(table):
            name, ground, courses = table.get("name"), table.get("ground"), table.get("courses")
            entries = [ground.get("heights")] if isinstance(ground, dict) else []
            entries += [c.get("points") for c in courses if isinstance(c, dict)] if isinstance(courses, list) else []
        else:
            entries = [table.get("heights"), table.get("frictions")]
    paths = [path for item in entries if isinstance(item, str) and is_file(path := file.parent / item)]
    meshes = [path for path in paths if path.suffix.lower() == ".gltf"]
    paths += [buffer for mesh in meshes for buffer in named_files(mesh)[1]]
    return name if isinstance(name, str) else file.stem, paths


def _buffers(file: Path) -> list[str]:
    """Names of the buffers of a glTF file."""
    with suppress(RoadFileError):  # the fault is reported when the mesh is read
        content = read_json(file, RoadFileError)
        buffers = content.get("buffers") if isinstance(content, dict) else None
        names = [b.get("uri") for b in buffers if isinstance(b, dict)] if isinstance(buffers, list) else []
        return [unquote(name) for name in names if isinstance(name, str)]
    return []
