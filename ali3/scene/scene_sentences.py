"""From what the types of a scene refuse to sentences: place, value, and what would be right."""

from collections.abc import Mapping, Sequence
from typing import Any

from pydantic import BaseModel, ValidationError

from ali3.message_text import brief, place_text, value_text
from ali3.near_names import near_names
from ali3.scene import road_types, scenery_types
from ali3.scene import scene_types as types
from ali3.scene.scene_values import NAME, UNIT, Part

UNKNOWN, MISSING = "extra_forbidden", "missing"
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
# A shape, a road: the types whose key `kind` chooses them.
_KINDS: dict[str, type[BaseModel]] = {
    model.model_fields["kind"].annotation.__args__[0]: model  # type: ignore[union-attr]
    for model in _MODELS.values()
    if "kind" in model.model_fields
}
# The tables of a key, where no tag names them.
_OF_KEY: dict[str, type[BaseModel]] = {
    "meshes": types.Mesh,
    "flexible": types.Flexible,
    "missing": types.Missing,
    "stress": types.Stress,
    "gauges": types.Gauge,
    "tyre": types.Tyre,
    "patches": road_types.Patch,
    "surface": road_types.SurfaceMap,
}
# What a table that could be of several types must have.
_CHOICES: dict[tuple[str | int, ...], str] = {
    ("frames",): "the keys 'position' and 'quaternion', 'parent' with 'axis' and 'angle' or with 'direction' "
    "and 'way', or 'points' and 'on'",
    ("arrows",): "the keys 'value' and 'between', 'vector' and 'at', or 'tyre'",
}


def sentences(scene: Mapping[str, Any], error: ValidationError) -> list[str]:
    """A sentence for each fault; a key that is misspelt is not missing besides."""
    items = sorted(error.errors(include_url=False), key=lambda item: item["type"] != UNKNOWN)
    lengths: dict[tuple[str | int, ...], int] = {}
    for item in items:
        if item["type"] == MISSING and isinstance(item["loc"][-1], int):
            path = _path(scene, item["loc"])[:-1]
            lengths[path] = max(lengths.get(path, 0), item["loc"][-1] + 1)
    lost = {_path(scene, item["loc"]) for item in items if item["type"] == MISSING}
    found: list[str] = []
    for item in items:
        path = _path(scene, item["loc"])
        if item["type"] == UNKNOWN:
            keys = [other[-1] for other in lost if other[:-1] == path[:-1]]
            near = _near(str(path[-1]), keys) or _near(str(path[-1]), _keys(item["loc"]))
            if near is not None:
                lost.discard((*path[:-1], near))
                found.append(f"{place(path)} is not known; did you mean '{near}'?")
            else:
                known = ", ".join(_keys(item["loc"]))
                found.append(f"{place(path)} is not known; the keys of {place(path[:-1])} are {known}.")
        elif item["type"] != MISSING or path in lost:
            found.append(_sentence(scene, item, path, lengths))
    return list(dict.fromkeys(found))


def place(path: Sequence[str | int]) -> str:
    """A place in a scene, such as ``shapes[3].radius`` or ``frames['wheel FL'].axis``."""
    return place_text(path) or "the scene"


def _sentence(
    scene: Mapping[str, Any], item: Any, path: tuple[str | int, ...], lengths: Mapping[tuple[str | int, ...], int]
) -> str:
    kind, message = item["type"], str(item["msg"])
    if kind == MISSING and isinstance(path[-1], str):
        why = _description(item["loc"])
        return f"{place(path)} is missing{f': {why}' if why else ''}."
    if path[:1] in _CHOICES and kind == "union_tag_not_found":
        given = item["input"]
        if not isinstance(given, Mapping):
            return f"{place(path)} is {value_text(given)}; it must be a table."
        unknown = [f"{brief(str(key))} is not known" for key in given if key not in ("name", "unit", "start")]
        hint = f" ({unknown[0]})" if unknown else ""
        return f"{place(path)} must have {_CHOICES[path[:1]]}{hint}."
    if kind in ("union_tag_invalid", "union_tag_not_found"):
        known = item.get("ctx", {}).get("expected_tags") or ", ".join(repr(k) for k in _kinds_at(path))
        if not isinstance(item["input"], Mapping):
            return f"{place(path)} is {value_text(item['input'])}; it must be a table with a key 'kind'."
        if "kind" not in item["input"]:
            near = _near("kind", list(map(str, item["input"])))
            hint = f" ('{near}' is not known)" if near else ""
            return f"{place((*path, 'kind'))} is missing{hint}; it is one of {known}."
        return f"{place((*path, 'kind'))} is {value_text(item['input']['kind'])}; it must be one of {known}."
    value = item["input"]
    if kind in ("missing", "too_short", "too_long"):  # of a list
        path = path[:-1] if kind == MISSING else path
        whole = _at(scene, path)
        limit = item.get("ctx", {})
        wanted = limit.get("max_length", limit.get("min_length", lengths.get(path)))
        many = f"; it must have {'at least ' if kind == 'too_short' and 'min_length' in limit else ''}{wanted}"
        return f"{place(path)} has {len(whole)} entries{many if wanted is not None else ', too few'}."
    if kind == "string_pattern_mismatch":
        words = _PATTERNS.get(item["ctx"]["pattern"], "a colour such as '#3366cc'")
        if item["loc"][-1] == "[key]":
            return f"{place(path[:-1])} has the key {value_text(value)}; it must be {words}."
        return f"{place(path)} is {value_text(value)}; it must be {words}."
    if path and "[key]" in item["loc"]:
        known = message.replace("Input should be ", "") if kind == "literal_error" else "a text that is not empty"
        return f"{place(path[:-1])} has the key {value_text(value)}; it must be {known}."
    wanted = message.replace("Input should be ", "").replace("greater than or equal to", "at least")
    wanted = wanted.replace("less than or equal to", "at most").replace("greater than", "above")
    wanted = wanted.replace("a valid dictionary or instance of ", "a table ").replace("a valid dictionary", "a table")
    wanted = wanted.replace("a valid tuple", "a list").replace("a valid list", "a list").replace("a valid ", "a ")
    wanted = wanted.replace("String should have at least 1 character", "a text that is not empty")
    wanted = wanted.replace("a string", "a text").replace("a integer", "a whole number")
    wanted = wanted.replace("a boolean", "true or false")
    for name in _MODELS:
        wanted = wanted.replace(f"a table {name}", "a table")
    return f"{place(path)} is {value_text(value)}; it must be {wanted}."


def _at(scene: Any, path: Sequence[str | int]) -> Any:
    for part in path:
        scene = scene[part]
    return scene


def _path(scene: Any, loc: Sequence[str | int]) -> tuple[str | int, ...]:
    """Place of an error, without the names of types that pydantic puts into it."""
    path: list[str | int] = []
    here: Any = scene
    for k, part in enumerate(loc):
        last = k == len(loc) - 1
        if isinstance(here, Mapping):
            if part in here and not (part == here.get("kind") and not last and _is_tag(here, loc, k)):
                path.append(part)
                here = here[part]
            elif last and part != "[key]" and part not in _MODELS:
                path.append(part)
        elif isinstance(here, (list, tuple)) and isinstance(part, int):
            path.append(part)
            here = here[part] if part < len(here) else None
    return tuple(path)


def _is_tag(here: Mapping[str, Any], loc: Sequence[str | int], k: int) -> bool:
    """Whether a part that is also a key of the table stands for its kind: it follows the table's own number."""
    return isinstance(loc[k - 1], int) and loc[k] == here.get("kind")


def _model(loc: Sequence[str | int]) -> type[BaseModel]:
    """Type of the table that holds the last part of a location."""
    model: type[BaseModel] = types.Scene
    for part in loc[:-1]:
        if isinstance(part, str):
            model = _MODELS.get(part) or _KINDS.get(part) or _OF_KEY.get(part) or model
    return model


def _keys(loc: Sequence[str | int]) -> list[str]:
    return list(_model(loc).model_fields)


def _description(loc: Sequence[str | int]) -> str:
    field = _model(loc).model_fields.get(str(loc[-1]))
    text = (field.description or "").rstrip(".") if field is not None else ""
    return text[:1].lower() + text[1:]


def _kinds_at(path: Sequence[str | int]) -> list[str]:
    base = types.Shape if path and path[0] == "shapes" else Part
    shapes = [kind for kind, model in _KINDS.items() if issubclass(model, types.Shape)]
    return shapes if base is types.Shape else [kind for kind in _KINDS if kind not in shapes]


def _near(word: str, known: Sequence[str | int]) -> str | None:
    near = near_names(word, [str(k) for k in known], 1)
    return near[0] if near else None
