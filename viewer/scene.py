"""Reads and checks scenes: JSON tables of frames that columns move, shapes, arrows and roads."""

from __future__ import annotations

import json
from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from ali3.reading import LARGEST_JSON, json_of, read_bytes
from viewer.errors import SceneError
from viewer.scene_relations import relation_errors
from viewer.scene_sentences import sentences, value_words
from viewer.scene_types import Scene

SCHEMA_FILE = Path(__file__).with_name("scene.schema.json")


def scene_errors(scene: Any) -> list[str]:
    """What is wrong with a scene.

    Parameters
    ----------
    scene : object
        As `json.loads` gives it.

    Returns
    -------
    list of str
        A sentence for each fault, with its place, the value and what would be right; empty if there is none.
    """
    if not isinstance(scene, Mapping):
        return ["A scene is a table with the keys format, version, name, extent, frames and shapes."]
    if "format" in scene and scene["format"] != "ALi3 scene":
        return [f"format is {value_words(scene['format'])}; it must be 'ALi3 scene'."]
    if "version" in scene and scene["version"] != 1:
        return [f"version is {value_words(scene['version'])}; this viewer reads version 1."]
    plain = plain_scene(scene)
    try:
        Scene.model_validate(plain)
    except ValidationError as error:
        return sentences(plain, error)
    return relation_errors(plain)


def check_scene(scene: Any, source: str = "The scene") -> None:
    """Refuse what is no scene.

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
        It cannot be read, is no JSON, or not of the format.
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

    Parameters
    ----------
    scene : mapping
        With any mappings, lists and tuples in it.
    """
    return _plain(scene, False)


def json_schema() -> dict[str, Any]:
    """JSON Schema (draft 2020-12) of a scene; what holds between several places is not in it."""
    made = Scene.model_json_schema()
    head = {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Scene of ALi3",
        "$comment": "Written by python -m viewer.scene from viewer/scene_types.py.",
    }
    schema = {key: value for key, value in made.items() if key != "title"}
    plain: dict[str, Any] = _without_nulls(schema)
    return head | plain


def schema_text() -> str:
    """The schema as the file in the package has it."""
    return json.dumps(json_schema(), indent=2, ensure_ascii=False) + "\n"


def _plain(value: Any, by_name: bool) -> Any:
    """Tables whose keys are names of the user's keep them all."""
    if isinstance(value, Mapping):
        kept = {key: item for key, item in value.items() if by_name or item is not None}
        return {key: _plain(item, not by_name and key in ("frames", "meshes")) for key, item in kept.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(item, False) for item in value]
    return value


def _without_nulls(schema: Any) -> Any:
    """Without null, which a scene does not have, and the titles that types give to keys."""
    if isinstance(schema, list):
        return [_without_nulls(item) for item in schema]
    if not isinstance(schema, dict):
        return schema
    kept = {key: value for key, value in schema.items() if key != "discriminator" and not _title(key, value)}
    choices = [choice for choice in kept.get("anyOf", []) if choice != {"type": "null"}]
    if "anyOf" in kept and len(choices) < len(kept["anyOf"]):
        del kept["anyOf"]
        kept = ({"anyOf": choices} if len(choices) > 1 else choices[0]) | kept
        if kept.get("default", 0) is None:
            del kept["default"]
    return {key: _without_nulls(value) for key, value in kept.items()}


def _title(key: str, value: object) -> bool:
    return key == "title" and isinstance(value, str)


if __name__ == "__main__":
    from ali3.files import write_text

    write_text(SCHEMA_FILE, schema_text())
