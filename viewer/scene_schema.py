"""Writes the JSON Schema of scenes from their types: ``python -m viewer.scene_schema``."""

import json
from pathlib import Path
from typing import Any

from ali3.scene.scene_types import Scene

SCHEMA_FILE = Path(__file__).with_name("scene.schema.json")


def json_schema() -> dict[str, Any]:
    """JSON Schema (draft 2020-12) of a scene, without relations between entries."""
    generated = Scene.model_json_schema()
    header = {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Scene of ALi3",
        "$comment": "Written by python -m viewer.scene_schema from ali3/scene/scene_types.py.",
    }
    schema = {key: value for key, value in generated.items() if key != "title"}
    plain: dict[str, Any] = _without_nulls(schema)
    return header | plain


def schema_text() -> str:
    """Text of the schema file."""
    return json.dumps(json_schema(), indent=2, ensure_ascii=False) + "\n"


def _without_nulls(schema: Any) -> Any:
    """A schema without null, which scenes do not have, and without the generated titles of keys."""
    if isinstance(schema, list):
        return [_without_nulls(item) for item in schema]
    if not isinstance(schema, dict):
        return schema
    entries = {key: value for key, value in schema.items() if key != "discriminator" and not _is_title(key, value)}
    choices = [choice for choice in entries.get("anyOf", []) if choice != {"type": "null"}]
    if "anyOf" in entries and len(choices) < len(entries["anyOf"]):
        del entries["anyOf"]
        entries = ({"anyOf": choices} if len(choices) > 1 else choices[0]) | entries
        if entries.get("default", 0) is None:
            del entries["default"]
    return {key: _without_nulls(value) for key, value in entries.items()}


def _is_title(key: str, value: object) -> bool:
    return key == "title" and isinstance(value, str)


if __name__ == "__main__":
    from ali3.files import write_text

    write_text(SCHEMA_FILE, schema_text())
