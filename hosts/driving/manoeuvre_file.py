"""Manoeuvres as files: one in TOML with all that belongs to it, or a plain CSV file."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ali3.near_names import did_you_mean
from ali3.reading import LARGEST_TEXT, is_file, no_file, read_toml
from hosts.common.errors import HostError
from hosts.common.numbers import text_of
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.manoeuvre_table import read_table
from hosts.driving.manoeuvres import FOLDER, manoeuvre_names
from hosts.driving.state_file import read_state

SUFFIXES = (".toml", ".csv")
"""Of files that hold manoeuvres."""
_KEYS = ("stop_time", "held", "find_throttle", "start", "driver", "inputs", "state")


def read_manoeuvre(manoeuvre: str, stop_time: float | None = None) -> Manoeuvre:
    """Read a manoeuvre by name or path.

    `manoeuvre`: name of a manoeuvre of the host, or a file in TOML or CSV; see `read_table`. A TOML file has
    ``stop_time`` in s, ``[start]`` values, settings of a ``[driver]``, ``[inputs]`` with a list of numbers for ``time``
    and each input, ``held``, a list of those that keep a value up to the next time, ``find_throttle``, true
    where the throttle is the one that holds the speed of the start, and a ``[state]`` of the FMU to begin with:
    ``file`` beside it, ``time``. `stop_time`: in place of its own, s. Raises `HostError` with the line or
    key and the reason.
    """
    path = Path(manoeuvre)
    check_manoeuvre(manoeuvre)
    if path.suffix not in SUFFIXES:
        path = next(p for p in (FOLDER / f"{manoeuvre}{suffix}" for suffix in SUFFIXES) if is_file(p))
    if path.suffix == ".toml":
        made = _read_toml(path)
    else:
        if not is_file(path):
            raise HostError(no_file(path))
        made = read_table(path)
    if stop_time is not None:
        return replace(made, stop_time=stop_time)
    if not made.stop_time > 0.0:
        raise HostError(f"{path} does not say how long it lasts; give a later time in the table or a stop_time.")
    return made


def check_manoeuvre(manoeuvre: str) -> None:
    """Refuse a word that is neither a file nor the name of a manoeuvre, before anything is made for it.

    `manoeuvre`: as `read_manoeuvre` takes it. Raises `HostError`: with near names, or all.
    """
    if Path(manoeuvre).suffix in SUFFIXES or manoeuvre in (names := manoeuvre_names()):
        return
    near = did_you_mean(manoeuvre, names, f"give a file.toml, a file.csv or one of: {', '.join(names)}")
    raise HostError(f"There is no manoeuvre '{manoeuvre}'{near}")


def _read_toml(path: Path) -> Manoeuvre:
    content = read_toml(path, HostError, largest=LARGEST_TEXT)
    unknown = next((key for key in content if key not in _KEYS), None)
    if unknown is not None:
        raise HostError(f"{path} has '{unknown}'; known are {', '.join(_KEYS)}.")
    time, inputs = _inputs(_table(content, "inputs", path), path)
    start = _table(content, "start", path)
    for name, value in start.items():
        _check(value, f"{path}, start value '{name}'")
    driver = _table(content, "driver", path)
    for name, value in driver.items():
        _check(value, f"{path}, driver: {name}")
    stop_time = float(time[-1]) if len(time) else math.nan
    if "stop_time" in content:
        stop_time = _number(content["stop_time"], f"{path}: stop_time")
        if stop_time <= 0.0:
            raise HostError(f"{path}: stop_time is {stop_time:g} s; it must be positive.")
    words = {name: value if isinstance(value, str) else text_of(value) for name, value in driver.items()}
    state = _state(_table(content, "state", path), path)
    held = content.get("held", [])
    if not isinstance(held, list) or any(not isinstance(name, str) or name not in inputs for name in held):
        raise HostError(f"{path}: held must be a list of names of [inputs].")
    find = content.get("find_throttle", False)
    if not isinstance(find, bool):
        raise HostError(f"{path}: find_throttle is {json.dumps(find, default=str)[:40]}; it must be true or false.")
    if find and (words or "throttle" in inputs):
        raise HostError(f"{path}: with find_throttle there is no {'[driver]' if words else 'throttle in [inputs]'}.")
    return Manoeuvre(path.stem, time, inputs, stop_time, start, words, *state, frozenset(held), find)


def _table(content: Mapping[str, Any], key: str, path: Path) -> dict[str, Any]:
    """A table by whole names: ``initial.speed = 1`` is a table ``initial`` for TOML."""
    table = content.get(key, {})
    if not isinstance(table, dict):
        raise HostError(f"{path}: {key} must be a table, [{key}].")
    return dict(_whole(table))


def _whole(table: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    for key, value in table.items():
        if isinstance(value, dict):
            yield from ((f"{key}.{rest}", inner) for rest, inner in _whole(value))
        else:
            yield key, value


def _inputs(table: Mapping[str, Any], path: Path) -> tuple[NDArray[np.float64], dict[str, NDArray[np.float64]]]:
    if not table:
        return np.zeros(0), {}
    if "time" not in table or len(table) < 2:
        raise HostError(f"{path}: [inputs] has {', '.join(table)}; it must have time and inputs.")
    columns = {}
    for name, values in table.items():
        if not isinstance(values, list) or not values:
            raise HostError(f"{path}, inputs: '{name}' must be a list of numbers.")
        columns[name] = np.array([_number(value, f"{path}, inputs: '{name}'") for value in values])
    for name, column in columns.items():
        if len(column) != len(columns["time"]):
            raise HostError(f"{path}, inputs: '{name}' has {len(column)} values where time has {len(columns['time'])}.")
    time = columns.pop("time")
    back = np.flatnonzero(np.diff(time) < 0.0)
    if len(back):
        raise HostError(f"{path}, inputs: time goes back from {time[back[0]]:g} s to {time[back[0] + 1]:g} s.")
    return time, columns


def _number(value: Any, where: str) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise HostError(f"{where}: {json.dumps(value, default=str)[:40]} is not a number.")
    return float(value)


def _check(value: Any, where: str) -> None:
    if not isinstance(value, (bool, int, float, str)):
        raise HostError(f"{where}: it must be a number, true, false or a text.")


def _state(table: Mapping[str, Any], path: Path) -> tuple[bytes | None, float]:
    if not table:
        return None, 0.0
    if set(table) != {"file", "time"} or not isinstance(table["file"], str):
        raise HostError(f"{path}: [state] must have the name of a file and a time.")
    return read_state(path.parent, table["file"], str(path)), _number(table["time"], f"{path}, time of the state")
