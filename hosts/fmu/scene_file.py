"""Reads a scene from an FMU or from a scene file."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ali3.archives import is_archive
from ali3.reading import is_file, missing_file_text
from ali3.scene.errors import SceneError
from ali3.scene.scene import read_scene
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.fmu.geometry import scene_of


def scene_from(
    path: Path, settings: Mapping[str, Value] | None = None, world: str | None = None
) -> dict[str, Any] | None:
    """The scene of an FMU, or of a JSON file; see `scene_of`."""
    if not is_file(path):
        raise HostError(missing_file_text(path))
    if not is_archive(path):
        try:
            return read_scene(path)
        except SceneError as error:
            raise HostError(f"{path} is neither an FMU nor a scene: {error}") from None
    return scene_of(path, settings, world)
