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
    """Sentences on the faults of a scene, each with location, value and what would be right.

    `scene`: result of `json.loads`.
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
        Result of `json.loads`.
    source : str
        Name of the scene in messages.

    Raises
    ------
    SceneError
        The scene has faults; the message has the first fault and the number of others.
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
    """A scene of plain dicts and lists, without keys whose value is null, which mean missing keys."""
    return _without_nulls(scene, False)


def _without_nulls(value: Any, has_user_keys: bool) -> Any:
    """Content without null; tables with keys of the user retain all keys."""
    if isinstance(value, Mapping):
        entries = {key: item for key, item in value.items() if has_user_keys or item is not None}
        return {
            key: _without_nulls(item, not has_user_keys and key in ("frames", "meshes"))
            for key, item in entries.items()
        }
    if isinstance(value, (list, tuple)):
        return [_without_nulls(item, False) for item in value]
    return value
