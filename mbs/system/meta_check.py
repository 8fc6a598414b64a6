"""Check of the metadata of a System file."""

from collections.abc import Mapping
from typing import Any

_FIELDS: dict[str, type] = {"name": str, "dimension": int, "report": dict, "experiment": dict, "floating": bool}
"""Keys and types of single values."""
_TEXTS: dict[str, type] = {"name": str, "unit": str, "description": str}
_LISTS: dict[str, dict[str, type]] = {
    "rows": {"name": str, "kind": str},
    "inputs": _TEXTS | {"start": float},
    "sensors": _TEXTS,
    "parameters": _TEXTS | {"value": float, "min": float, "max": float},
    "elements": {"name": str, "type": str, "outputs": list},
    "switches": {"name": str},
    "constants": _TEXTS | {"value": float},
    "ahead": _TEXTS | {"value": str, "rate": str},  # outputs of FMUs: sensor `value`, extrapolated with sensor `rate`
    "road_files": {"name": str, "road": int, "start": str, "description": str},
}
"""Keys and types of the entries of each list."""
_TYPE_TEXTS = {str: "a text", int: "a whole number", float: "a number", list: "a list"}
_OPTIONAL = ("constants", "road_files", "ahead")
"""Lists that older files do not have."""
_ARRAY_OF_LIST = {"rows": "row_const", "inputs": "input_start", "sensors": "sen_type", "parameters": "par_value"}
"""Array with one item for each entry of the list."""


def find_meta_error(meta: Any, lengths: Mapping[str, int]) -> str:
    """Find the first error in metadata; return it as a clause, or "".

    `meta`: value read from JSON; `lengths`: number of items of each array of the System.
    """
    if not isinstance(meta, dict):
        return "metadata is not an object"
    for key, kind in _FIELDS.items():
        if not _has_type(meta.get(key), kind):
            return f"'{key}' is missing or has the wrong type"
    for key in ("step_s", "stop_time_s"):
        value = meta["experiment"].get(key)
        if not (_has_type(value, float) and value > 0.0):
            return f"'experiment.{key}' is missing or not a positive number"
    for key in ("coordinates", "guides"):
        if not (isinstance(meta.get(key), list) and all(isinstance(name, str) for name in meta[key])):
            return f"'{key}' is missing or not a list of names"
    if len(meta["coordinates"]) != lengths["q0"]:
        return f"'coordinates' has {len(meta['coordinates'])} entries; it must have {lengths['q0']}"
    return next((text for key in _LISTS if (text := _find_list_error(key, meta.get(key), lengths))), "")


def _find_list_error(key: str, entries: Any, lengths: Mapping[str, int]) -> str:
    """Find the first error in the value `entries` of a list; return it as a clause, or ""."""
    if entries is None and key in _OPTIONAL:
        return ""
    if not isinstance(entries, list):
        return f"'{key}' is missing or not a list"
    if key in _ARRAY_OF_LIST and len(entries) != lengths[_ARRAY_OF_LIST[key]]:
        return f"'{key}' has {len(entries)} entries; it must have {lengths[_ARRAY_OF_LIST[key]]}"
    for k, entry in enumerate(entries):
        for field, kind in _LISTS[key].items():
            if not (isinstance(entry, dict) and _has_type(entry.get(field), kind)):
                return f"entry {k} of '{key}' has no '{field}' that is {_TYPE_TEXTS[kind]}"
        if key == "inputs" and not all(
            bound in entry and (entry[bound] is None or _has_type(entry[bound], float)) for bound in ("min", "max")
        ):
            return f"entry {k} of '{key}' has a 'min' or 'max' that is neither a number nor null"
    return ""


def _has_type(value: Any, kind: type) -> bool:
    if isinstance(value, bool):  # Python counts it as an integer
        return kind is bool
    return isinstance(value, int | float if kind is float else kind)
