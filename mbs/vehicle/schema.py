"""JSON Schema of the car file, for editors and validators, from the types that read it."""

import json
from pathlib import Path
from typing import Any

from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue
from pydantic_core import core_schema

from mbs.vehicle.car import Car

SCHEMA_FILE = Path(__file__).with_name("car.schema.json")
DRAFT = "http://json-schema.org/draft-07/schema#"  # the version that TOML plugins of editors read
NULL = {"type": "null"}


def json_schema() -> dict[str, Any]:
    """Schema of a car file, draft 7.

    Numbers also have the keyword `unit`; what holds between several numbers is not in it.

    Returns
    -------
    dict
        As `json.dumps` takes it.
    """
    schema = Car.model_json_schema(ref_template="#/definitions/{model}", schema_generator=_Generator)
    schema["definitions"] = dict(sorted(schema.pop("$defs").items()))
    schema["definitions"] = {name: _simplify(table) for name, table in schema["definitions"].items()}
    head: dict[str, Any] = {"$schema": DRAFT, "title": "Car file of ALi3"}
    head.update(_simplify({key: value for key, value in schema.items() if key != "title"}))
    return head


def schema_text() -> str:
    """Text of the schema file of the package."""
    return json.dumps(json_schema(), indent=2, ensure_ascii=False) + "\n"


class _Generator(GenerateJsonSchema):
    """Generator of schemas with lists as in draft 7."""

    def tuple_schema(self, schema: core_schema.TupleSchema) -> JsonSchemaValue:
        """Schema of an array with one schema for all its elements if these are equal."""
        items = schema["items_schema"]
        inner = [self.generate_inner(item) for item in items]
        alike = all(item == inner[0] for item in inner)
        array_schema: JsonSchemaValue = {"type": "array", "items": inner[0] if alike else inner}
        if schema.get("variadic_item_index") is None:
            return array_schema | {"minItems": len(items), "maxItems": len(items)}
        limits = {"minItems": schema.get("min_length"), "maxItems": schema.get("max_length")}
        return array_schema | {key: value for key, value in limits.items() if value is not None}


def _simplify(schema: Any) -> Any:
    """Schema without null, which TOML does not have, titles, and discriminators."""
    if isinstance(schema, list):
        return [_simplify(item) for item in schema]
    if not isinstance(schema, dict):
        return schema
    plain = {key: value for key, value in schema.items() if key not in ("title", "discriminator", "definitions")}
    choices = [choice for choice in plain.get("anyOf", []) if choice != NULL]
    if "anyOf" in plain and len(choices) < len(plain["anyOf"]):
        del plain["anyOf"]
        plain = ({"anyOf": choices} if len(choices) > 1 else choices[0]) | plain
        if plain.get("default", 0) is None:
            del plain["default"]
    if "patternProperties" in plain:
        plain["additionalProperties"] = False
    converted = {
        key: {name: _with_unit(_simplify(value)) for name, value in inner.items()}
        if key == "properties"
        else _simplify(inner)
        for key, inner in plain.items()
    }
    return converted | ({"definitions": schema["definitions"]} if "definitions" in schema else {})


def _with_unit(schema: Any) -> Any:
    """Schema of a field with its unit in the description, which editors display."""
    items = schema.get("items", {})
    unit = schema.get("unit") or (items.get("unit") if isinstance(items, dict) else None)
    text = " ".join(schema.get("description", "").split())
    if text:
        schema["description"] = text if unit in (None, "1") else f"{text.rstrip('.')}, {unit}."
    return schema
