"""Check of the `meta` data of a System file."""

from collections.abc import Mapping
from typing import Any

_TEXTS: dict[str, type] = {"name": str, "unit": str, "description": str}
_LISTS: dict[str, dict[str, type]] = {
    "rows": {"name": str, "kind": str},
    "inputs": _TEXTS | {"start": float},
    "sensors": _TEXTS,
    "parameters": _TEXTS | {"value": float, "min": float, "max": float},
    "elements": {"name": str, "type": str, "outputs": list},
    "switches": {"name": str},
    "constants": _TEXTS | {"value": float},
    "ahead": _TEXTS | {"value": str, "rate": str},
    "road_files": {"name": str, "road": int, "start": str, "description": str},
}
"""Keys and types of the entries of each list."""
_OPTIONAL = ("constants", "road_files", "ahead")
"""Lists that older files do not have."""
_COUNTED = {"rows": "row_const", "inputs": "input_start", "sensors": "sen_type", "parameters": "par_value"}
"""Arrays whose lengths are the numbers of entries."""


def meta_problem(meta: Any, lengths: Mapping[str, int]) -> str:
    """Fault in metadata, as the end of a sentence; empty if there is none.

    `meta`: read from JSON; `lengths`: of the arrays of the System.
    """
    if not isinstance(meta, dict):
        return "they are not a table"
    for key, kind in (("name", str), ("dimension", int), ("report", dict), ("experiment", dict), ("floating", bool)):
        if not isinstance(meta.get(key), kind):
            return f"'{key}' is missing or of another kind"
    for key in ("step_s", "stop_time_s"):
        value = meta["experiment"].get(key)
        if not (_is_kind(value, float) and value > 0.0):
            return f"'experiment.{key}' is missing or no positive number"
    for key in ("coordinates", "guides"):
        if not (isinstance(meta.get(key), list) and all(isinstance(name, str) for name in meta[key])):
            return f"'{key}' is missing or no list of names"
    if len(meta["coordinates"]) != lengths["q0"]:
        return f"'coordinates' names {len(meta['coordinates'])} of {lengths['q0']}"
    return next((text for key in _LISTS if (text := _list_problem(key, meta.get(key), lengths))), "")


def _list_problem(key: str, entries: Any, lengths: Mapping[str, int]) -> str:
    if entries is None and key in _OPTIONAL:
        return ""
    if not isinstance(entries, list):
        return f"'{key}' is missing or no list"
    if key in _COUNTED and len(entries) != lengths[_COUNTED[key]]:
        return f"'{key}' names {len(entries)} of {lengths[_COUNTED[key]]}"
    for k, entry in enumerate(entries):
        for field, kind in _LISTS[key].items():
            if not (isinstance(entry, dict) and _is_kind(entry.get(field), kind)):
                return f"entry {k} of '{key}' has no '{field}', or one of another kind"
        if key == "inputs" and not all(
            end in entry and (entry[end] is None or _is_kind(entry[end], float)) for end in ("min", "max")
        ):
            return f"entry {k} of '{key}' has a range of another kind"
    return ""


def _is_kind(value: Any, kind: type) -> bool:
    if kind is float:
        return isinstance(value, int | float) and not isinstance(value, bool)
    return isinstance(value, kind)
