"""Reads and checks scenes: JSON tables of frames that columns move, shapes, arrows and roads."""

from collections.abc import Mapping
from os import PathLike
from typing import Any

from pydantic import ValidationError

from ali3.json_reading import LARGEST_JSON, json_of
from ali3.message_text import value_text
from ali3.reading import read_bytes
from ali3.scene.errors import SceneError
from ali3.scene.scene_relations import relation_errors
from ali3.scene.scene_sentences import sentences
from ali3.scene.scene_types import Scene


def scene_errors(scene: Any) -> list[str]:
    """What is wrong with a scene. `scene`: as `json.loads` gives it.

    Returns a sentence for each fault, with its place, the value and what would be right; empty if there is none.
    """
    if not isinstance(scene, Mapping):
        return ["A scene is a table with the keys format, version, name, extent, frames and shapes."]
    if "format" in scene and scene["format"] != "ALi3 scene":
        return [f"format is {value_text(scene['format'])}; it must be 'ALi3 scene'."]
    if "version" in scene and scene["version"] != 1:
        return [f"version is {value_text(scene['version'])}; this viewer reads version 1."]
    plain = plain_scene(scene)
    try:
        Scene.model_validate(plain)
    except ValidationError as error:
        return sentences(plain, error)
    return relation_errors(plain)


def check_scene(scene: Any, source: str = "The scene") -> None:
    """Refuse what is not a scene.

    Parameters
    ----------
    scene : object
        As `json.loads` gives it.
    source : str
        How the message calls it.

    Raises
    ------
    SceneError
        With the first fault, and how many more there are.
    """
    errors = scene_errors(scene)
    if errors:
        more = f" ({len(errors) - 1} more faults.)" if len(errors) > 1 else ""
        raise SceneError(f"{source}: {errors[0]}{more}")


def read_scene(source: str | bytes | PathLike[str], name: str = "") -> dict[str, Any]:
    """Read a scene from a file, or from the bytes of one.

    Parameters
    ----------
    source : path or bytes
        The file, or its content.
    name : str
        How messages call it; by default the path.

    Raises
    ------
    SceneError
        It cannot be read, is not JSON, or not of the format.
    """
    if isinstance(source, bytes):
        data, name = source, name or "The scene"
    else:
        name = name or str(source)
        data = read_bytes(source, LARGEST_JSON, SceneError, name)
    scene = json_of(data, SceneError, name)
    check_scene(scene, name)
    return dict(scene)


def plain_scene(scene: Any) -> Any:
    """A scene as JSON gives it, without keys whose value is null: they stand for keys that are left out.

    `scene`: with any mappings, lists and tuples in it.
    """
    return _plain(scene, False)


def _plain(value: Any, by_name: bool) -> Any:
    """Tables whose keys are names of the user's keep them all."""
    if isinstance(value, Mapping):
        entries = {key: item for key, item in value.items() if by_name or item is not None}
        return {key: _plain(item, not by_name and key in ("frames", "meshes")) for key, item in entries.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(item, False) for item in value]
    return value
