"""Reads descriptions of worlds."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

from mbs.roads.road_header import RoadFileError


def read_table(file: Path) -> dict[str, Any]:
    """A TOML file as it is.

    Raises
    ------
    RoadFileError
        It cannot be read.
    """
    try:
        return tomllib.loads(file.read_text(encoding="utf-8-sig"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise RoadFileError(f"{file} cannot be read: {getattr(error, 'strerror', None) or error}.") from None


def named_files(file: Path) -> tuple[str, list[Path]]:
    """The name of a world, and the files that its description names, as far as they are there."""
    table = read_table(file)
    found = []
    if table.get("kind") == "world":
        ground = table.get("ground")
        courses = table.get("courses")
        found = [ground.get("heights")] if isinstance(ground, dict) else []
        found += [c.get("points") for c in courses if isinstance(c, dict)] if isinstance(courses, list) else []
    else:
        found = [table.get("heights"), table.get("frictions")]
    name = table.get("name") if table.get("kind") == "world" else None
    paths = [file.parent / item for item in found if isinstance(item, str)]
    return name if isinstance(name, str) else file.stem, [path for path in paths if path.is_file()]
