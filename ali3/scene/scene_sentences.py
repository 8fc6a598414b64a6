"""Writes a sentence for each error that pydantic finds in a scene: path, value, and what would be right."""

import re
from collections.abc import Mapping, Sequence
from typing import Any

from pydantic import BaseModel, ValidationError

from ali3.message_text import brief, place_text, value_text
from ali3.near_names import near_names
from ali3.scene import road_types, scenery_types
from ali3.scene import scene_types as types
from ali3.scene.scene_values import NAME, UNIT, Part

UNKNOWN = "extra_forbidden"
MISSING = "missing"
_PATTERNS = {
    NAME: "a name without control characters, '<' and '>'",
    UNIT: "a unit such as 'N.m', without control characters, quotes, '&', '<' and '>', of at most 40 characters",
}
_MODELS: dict[str, type[BaseModel]] = {
    name: model
    for module in (types, road_types, scenery_types)
    for name, model in vars(module).items()
    if isinstance(model, type) and issubclass(model, Part)
}
# Types that the key `kind` chooses, such as types of shapes and roads.
_KINDS: dict[str, type[BaseModel]] = {
    model.model_fields["kind"].annotation.__args__[0]: model  # type: ignore[union-attr]
    for model in _MODELS.values()
    if "kind" in model.model_fields
}
# Types of tables by key, where no tag names them.
_MODEL_OF_KEY: dict[str, type[BaseModel]] = {
    "meshes": types.Mesh,
    "flexible": types.Flexible,
    "missing": types.Missing,
    "stress": types.Stress,
    "gauges": types.Gauge,
    "tyre": types.Tyre,
    "patches": road_types.Patch,
    "surface": road_types.SurfaceMap,
}
# Keys that determine the type of a table.
_CHOICES: dict[tuple[str | int, ...], str] = {
    ("frames",): "the keys 'position' and 'quaternion', 'parent' with 'axis' and 'angle' or with 'direction' "
    "and 'way', or 'points' and 'on'",
    ("arrows",): "the keys 'value' and 'between', 'vector' and 'at', or 'tyre'",
}
# Texts of pydantic as regular expressions, and their replacements.
_REPLACEMENTS = (
    ("Input should be ", ""),
    ("greater than or equal to", "at least"),
    ("less than or equal to", "at most"),
    ("greater than", "above"),
    (r"a valid dictionary( or instance of \w+)?", "a table"),
    ("a valid (tuple|list)", "a list"),
    ("String should have at least 1 character", "a text that is not empty"),
    ("a (valid )?string", "a text"),
    ("a valid integer", "a whole number"),
    ("a valid boolean", "true or false"),
    ("a valid ", "a "),
)


def sentences(scene: Mapping[str, Any], error: ValidationError) -> list[str]:
    """A sentence for each error; the right key of a misspelt one is not reported as missing too."""
    items = sorted(error.errors(include_url=False), key=lambda item: item["type"] != UNKNOWN)
    lengths: dict[tuple[str | int, ...], int] = {}
    for item in items:
        if item["type"] == MISSING and isinstance(item["loc"][-1], int):
            path = _path(scene, item["loc"])[:-1]
            lengths[path] = max(lengths.get(path, 0), item["loc"][-1] + 1)
    missing_paths = {_path(scene, item["loc"]) for item in items if item["type"] == MISSING}
    results: list[str] = []
    for item in items:
        path = _path(scene, item["loc"])
        if item["type"] == UNKNOWN:
            keys = [other[-1] for other in missing_paths if other[:-1] == path[:-1]]
            near = _near_name(str(path[-1]), keys) or _near_name(str(path[-1]), _keys(item["loc"]))
            if near is not None:
                missing_paths.discard((*path[:-1], near))
                results.append(f"{place(path)} is not known; did you mean '{near}'?")
            else:
                known_names = ", ".join(_keys(item["loc"]))
                results.append(f"{place(path)} is not known; the keys of {place(path[:-1])} are {known_names}.")
        elif item["type"] != MISSING or path in missing_paths:
            results.append(_sentence(scene, item, path, lengths))
    return list(dict.fromkeys(results))


def place(path: Sequence[str | int]) -> str:
    """A location in a scene, such as ``shapes[3].radius`` or ``frames['wheel FL'].axis``."""
    return place_text(path) or "the scene"


def _sentence(
    scene: Mapping[str, Any], item: Any, path: tuple[str | int, ...], lengths: Mapping[tuple[str | int, ...], int]
) -> str:
    """Sentence for one fault. `item`: error of pydantic; `lengths`: least lengths of lists that are too short."""
    kind, value = item["type"], item["input"]
    if kind == MISSING and isinstance(path[-1], str):
        description = _description(item["loc"])
        return f"{place(path)} is missing{f': {description}' if description else ''}."
    if kind in ("union_tag_invalid", "union_tag_not_found"):
        return _choice_sentence(item, path)
    if kind in (MISSING, "too_short", "too_long"):
        return _length_sentence(scene, item, path, lengths)
    key = "[key]" in item["loc"]
    if kind == "string_pattern_mismatch":
        requirement = _PATTERNS.get(item["ctx"]["pattern"], "a colour such as '#3366cc'")
    elif key and kind != "literal_error":
        requirement = "a text that is not empty"
    else:
        requirement = str(item["msg"])
        for pattern, replacement in _REPLACEMENTS:
            requirement = re.sub(pattern, replacement, requirement)
    if key:
        return f"{place(path[:-1])} has the key {value_text(value)}; it must be {requirement}."
    return f"{place(path)} is {value_text(value)}; it must be {requirement}."


def _choice_sentence(item: Any, path: tuple[str | int, ...]) -> str:
    """Sentence for a table whose keys, or whose key `kind`, choose none of the possible types."""
    entry = item["input"]
    by_keys = path[:1] in _CHOICES and item["type"] == "union_tag_not_found"
    if not isinstance(entry, Mapping):
        table = "a table" if by_keys else "a table with a key 'kind'"
        return f"{place(path)} is {value_text(entry)}; it must be {table}."
    if by_keys:
        unknown = next((key for key in entry if key not in ("name", "unit", "start")), None)
        hint = "" if unknown is None else f" ({brief(str(unknown))} is not known)"
        return f"{place(path)} must have {_CHOICES[path[:1]]}{hint}."
    kinds_text = item.get("ctx", {}).get("expected_tags") or ", ".join(map(repr, _kinds_at(path)))
    location = place((*path, "kind"))
    if "kind" in entry:
        return f"{location} is {value_text(entry['kind'])}; it must be one of {kinds_text}."
    near = _near_name("kind", list(map(str, entry)))
    return f"{location} is missing{f' ({near!r} is not known)' if near else ''}; it is one of {kinds_text}."


def _length_sentence(
    scene: Mapping[str, Any], item: Any, path: tuple[str | int, ...], lengths: Mapping[tuple[str | int, ...], int]
) -> str:
    """Sentence for a list with too few or too many entries."""
    path = path[:-1] if item["type"] == MISSING else path
    limits = item.get("ctx", {})
    count = limits.get("max_length", limits.get("min_length", lengths.get(path)))
    at_least = "at least " if item["type"] == "too_short" and "min_length" in limits else ""
    requirement = ", too few" if count is None else f"; it must have {at_least}{count}"
    return f"{place(path)} has {len(_value_at(scene, path))} entries{requirement}."


def _value_at(scene: Any, path: Sequence[str | int]) -> Any:
    for part in path:
        scene = scene[part]
    return scene


def _path(scene: Any, loc: Sequence[str | int]) -> tuple[str | int, ...]:
    """Path of an error, without the names of types that pydantic adds."""
    path: list[str | int] = []
    node: Any = scene
    for k, part in enumerate(loc):
        is_last = k == len(loc) - 1
        if isinstance(node, Mapping):
            if part in node and not (part == node.get("kind") and not is_last and _is_tag(node, loc, k)):
                path.append(part)
                node = node[part]
            elif is_last and part != "[key]" and part not in _MODELS:
                path.append(part)
        elif isinstance(node, (list, tuple)) and isinstance(part, int):
            path.append(part)
            node = node[part] if part < len(node) else None
    return tuple(path)


def _is_tag(table: Mapping[str, Any], loc: Sequence[str | int], k: int) -> bool:
    """Whether element `k`, which is also a key of the table, is its kind: it follows the index of the table."""
    return isinstance(loc[k - 1], int) and loc[k] == table.get("kind")


def _model(loc: Sequence[str | int]) -> type[BaseModel]:
    """Type of the table that holds the last part of a location."""
    model: type[BaseModel] = types.Scene
    for part in loc[:-1]:
        if isinstance(part, str):
            model = _MODELS.get(part) or _KINDS.get(part) or _MODEL_OF_KEY.get(part) or model
    return model


def _keys(loc: Sequence[str | int]) -> list[str]:
    return list(_model(loc).model_fields)


def _description(loc: Sequence[str | int]) -> str:
    field = _model(loc).model_fields.get(str(loc[-1]))
    text = (field.description or "").rstrip(".") if field is not None else ""
    return text[:1].lower() + text[1:]


def _kinds_at(path: Sequence[str | int]) -> list[str]:
    """Possible kinds of a table at a path: of shapes or of roads."""
    shapes = path[:1] == ("shapes",)
    return [kind for kind, model in _KINDS.items() if issubclass(model, types.Shape) == shapes]


def _near_name(word: str, known: Sequence[str | int]) -> str | None:
    near = near_names(word, [str(k) for k in known], 1)
    return near[0] if near else None
