"""Changes the content of a car file by key paths."""

import copy
from collections.abc import Mapping
from typing import Any

import numpy as np

from mbs.common.checks import shown
from mbs.vehicle.errors import CarFileError
from mbs.vehicle.section import AXES, PRODUCTS

INDICES = {part: str(k) for parts in (AXES, PRODUCTS) for k, part in enumerate(parts)}
"""Indices in a list by the last name of a parameter."""


def changed_content(data: Mapping[str, Any], values: Mapping[str, Any], what: str) -> dict[str, Any]:
    """Copy the content of a car file with other values.

    `data`: tables of the file; `values`: values by key path; missing keys are added. Raises `CarFileError` if a
    key path is malformed, or leads through a value.
    """
    if not isinstance(values, Mapping):
        raise CarFileError(f"{what}: the changes are {shown(values)}; they must be a mapping from key paths to values.")
    content = copy.deepcopy(dict(data))
    for path, value in values.items():
        if not isinstance(path, str) or not all(path.split(".")):
            raise CarFileError(f'{what}: {shown(path)} is not a key path; one is "front.spring.stiffness".')
        *tables, last = path.split(".")
        table: Any = content
        for k, key in enumerate(tables):
            if isinstance(table, dict):
                of_list = k + 1 == len(tables) and last in PRODUCTS
                table = table.setdefault(key, [0.0] * len(PRODUCTS) if of_list else {})
            else:
                table = table[_index(table, key, tables[:k], what)]
            if not isinstance(table, (dict, list)):
                raise CarFileError(
                    f"{what}: {path} is not known; {'.'.join(tables[: k + 1])} is {shown(table)}, which has no keys."
                )
        if isinstance(table, list):
            table[_index(table, last, tables, what)] = _to_python(value)
        else:
            table[last] = _to_python(value)
    return content


def value_at(data: Mapping[str, Any], path: str) -> Any:
    """Value at a key path of the content of a car file. Raises `KeyError` or `IndexError` if there is none."""
    value: Any = data
    for key in path.split("."):
        value = value[int(key)] if isinstance(value, list) else value[key]
    return value


def _index(table: list[Any], key: str, tables: list[str], what: str) -> int:
    """Index of an element of a list by its number or by the name of a parameter."""
    key = INDICES.get(key, key)
    if not key.isdigit() or int(key) >= len(table):
        path = ".".join(tables)
        raise CarFileError(f"{what}: {path}.{key} is not known; {path} is a list of {len(table)}, counted from 0.")
    return int(key)


def _to_python(value: Any) -> Any:
    """Value with NumPy numbers and arrays converted to numbers and lists of Python."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, Mapping):
        return {key: _to_python(inner) for key, inner in value.items()}
    if isinstance(value, (list, tuple)):
        return [_to_python(inner) for inner in value]
    return value
