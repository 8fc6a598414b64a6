"""Writes manoeuvres: as TOML files with all that belongs to them, or as tables."""

import json
import re
import textwrap
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ali3.decimal_number import parse_number
from ali3.files import write_text
from hosts.common.numbers import Value, text_of
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.run_record import write_state

_WIDTH = 116


def write_manoeuvre(manoeuvre: Manoeuvre, file: Path, comment: str = "") -> None:
    """Write a manoeuvre as a TOML file, as `read_manoeuvre` reads it.

    `file`: the state goes beside it, with the suffix ``.state``.
    """
    lines = [f"# {comment}"] if comment else []
    lines.append(f"stop_time = {manoeuvre.stop_time!r}")
    if manoeuvre.held:
        lines.append(f"held = {json.dumps(sorted(manoeuvre.held))}")
    if manoeuvre.find_throttle:
        lines.append("find_throttle = true")
    columns = {"time": manoeuvre.time, **manoeuvre.inputs} if manoeuvre.inputs else {}
    tables: dict[str, Mapping[str, Any]] = {
        "start": {name: _toml_value(value) for name, value in manoeuvre.start.items()},
        "driver": {name: _toml_setting(text) for name, text in manoeuvre.driver.items()},
        "state": {},
        "inputs": {name: _toml_list(values) for name, values in columns.items()},
    }
    if manoeuvre.state is not None:
        beside = write_state(manoeuvre.state, file)
        tables["state"] = {"file": _toml_value(beside.name), "time": repr(manoeuvre.state_time)}
    for title, table in tables.items():
        if table:
            lines += ["", f"[{title}]", *(f"{_toml_key(name)} = {text}" for name, text in table.items())]
    write_text(file, "\n".join(lines) + "\n")


def _toml_key(name: str) -> str:
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name, re.ASCII) else _toml_value(name)


def _toml_value(value: Value) -> str:
    return json.dumps(value, ensure_ascii=False) if isinstance(value, str) else text_of(value)


def _number_text(value: float) -> str:
    """The number in few digits if that is exact; TOML has no integer -0."""
    short = f"{value:g}"
    return short if float(short) == value and short != "-0" else repr(value)


def _toml_setting(text: str) -> str:
    """A setting of a driver, as a number if it is one."""
    try:
        return repr(parse_number(text))
    except ValueError:
        return _toml_value(text)


def _toml_list(values: NDArray[np.float64]) -> str:
    text = ", ".join(map(_number_text, values.tolist()))
    return f"[{text}]" if len(text) < _WIDTH else f"[\n{textwrap.indent(textwrap.fill(text, _WIDTH), '  ')},\n]"


def write_table(manoeuvre: Manoeuvre, file: Path) -> list[Path]:
    """Write inputs, start values and state as `read_table` reads them.

    `file`: the state goes beside it, with the suffix ``.state``.
    """
    files = [file]
    lines = [f"# start: {name}={text_of(value)}" for name, value in manoeuvre.start.items()]
    if manoeuvre.state is not None:
        files.append(write_state(manoeuvre.state, file))
        lines.append(f"# state: {files[-1].name} at {manoeuvre.state_time!r}")
    if manoeuvre.step is not None:
        lines.append(f"# step: {manoeuvre.step!r}")
    if manoeuvre.held:
        lines.append(f"# held: {', '.join(sorted(manoeuvre.held))}")
    lines.append(",".join(f'"{name}"' for name in ("time", *manoeuvre.inputs)))
    table = np.column_stack([manoeuvre.time, *manoeuvre.inputs.values()])
    lines += [",".join(map(repr, row)) for row in table.tolist()]
    write_text(file, "\n".join(lines) + "\n")
    return files
