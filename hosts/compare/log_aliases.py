"""The alias file of a log: how its table is written, its clock, and our names for its columns."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ali3.reading import is_file, read_toml
from hosts.common.errors import HostError
from hosts.common.numbers import is_finite

TIME_UNITS: Mapping[str, float | None] = {
    "s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0, "h": 3600.0, "epoch": 1.0, "epoch_ms": 1e-3,
    "epoch_us": 1e-6, "epoch_ns": 1e-9, "iso": None,
}  # fmt: skip
"""Seconds of a unit of time; None: texts such as ``2024-05-03T12:00:00.010``."""
_TABLES = ("file", "time", "signals")
_DIALECT = ("delimiter", "decimal", "encoding", "heading", "units")
_TIME = ("name", "unit", "factor", "offset")
_SIGNAL = ("name", "unit", "factor", "offset", "time")


@dataclass(frozen=True)
class Column:
    """A column of the log: number in the log = factor * value in `unit` + offset."""

    name: str
    unit: str | None = None
    """Without it that of the table's heading, else that of the FMU."""
    factor: float = 1.0
    offset: float = 0.0
    time: str | None = None
    """Column with the times of this one, where it is not that of the table."""


@dataclass(frozen=True)
class Clock:
    """The column of times: number in the log = factor * time in `unit` + offset."""

    name: str | None = None
    unit: str | None = None
    factor: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True)
class Dialect:
    """How a CSV file is written; what is None is found out from its first lines."""

    delimiter: str | None = None
    decimal: str | None = None
    encoding: str | None = None
    heading: int | None = None
    """Line of the names, the first is 1."""
    units: int | None = None
    """Line of the units; 0: there is none."""


@dataclass(frozen=True)
class LogAliases:
    """What an alias file says; without one the columns have our names."""

    dialect: Dialect = field(default_factory=Dialect)
    clock: Clock = field(default_factory=Clock)
    columns: Mapping[str, Column] = field(default_factory=dict)
    file: str = ""


def read_log_aliases(file: Path) -> LogAliases:
    """Read the alias file of a log.

    `file`: TOML with tables ``[file]``, ``[time]`` and ``[signals]``; in the last ``"our name" = "column"`` or ``"our
    name" = { name = "column", unit = "deg/s", factor = -1.0, offset = 0.0, time = "column of times" }``. Raises
    `HostError` with the file, the key and what would be right.
    """
    content = read_toml(file, HostError, f"The alias file {file}")
    unknown = next((key for key in content if key not in _TABLES), None)
    if unknown is not None:
        raise HostError(f"{file} has '{unknown}'; known are the tables [file], [time] and [signals].")
    for key in _TABLES:
        if not isinstance(content.get(key, {}), dict):
            raise HostError(f"{file}: '{key}' must be a table, [{key}].")
    dialect, clock = _dialect(content.get("file", {}), file), _clock(content.get("time", {}), file)
    columns = {ours: _column(value, f"{file}: '{ours}'") for ours, value in content.get("signals", {}).items()}
    return LogAliases(dialect, clock, columns, str(file))


def refuse_log_aliases(file: Path) -> None:
    """Refuse the alias file of a log where that of an FMU is asked for.

    Raises `HostError`: it has only tables of a log's file.
    """
    if is_file(file) and (content := read_toml(file)) and set(content) <= set(_TABLES):
        raise HostError(f"{file} is the alias file of a log; --log-aliases takes it, --aliases that of the FMU.")


def _dialect(table: dict[str, Any], file: Path) -> Dialect:
    _known(table, _DIALECT, f"{file}: [file]")
    for key in ("delimiter", "decimal", "encoding"):
        value = table.get(key)
        if value is not None and (not isinstance(value, str) or (key != "encoding" and len(value) != 1)):
            what = "a name such as utf-8 or latin-1" if key == "encoding" else "one character"
            raise HostError(f"{file}: [file] {key} is {value!r}; it must be {what}.")
    for key, least in (("heading", 1), ("units", 0)):
        value = table.get(key)
        if value is not None and (isinstance(value, bool) or not isinstance(value, int) or value < least):
            raise HostError(f"{file}: [file] {key} is {value!r}; it must be the number of a line.")
    for key, other in (("delimiter", "decimal"), ("heading", "units")):
        if table.get(key) is not None and table[key] == table.get(other):
            raise HostError(f"{file}: [file] {key} and {other} are both {table[key]!r}; they must differ.")
    return Dialect(**table)


def _clock(table: dict[str, Any], file: Path) -> Clock:
    where = f"{file}: [time]"
    _known(table, _TIME, where)
    name, unit = table.get("name"), table.get("unit")
    if name is not None and not isinstance(name, str):
        raise HostError(f"{where} name is {name!r}; it must be the name of a column.")
    if unit is not None and (not isinstance(unit, str) or unit not in TIME_UNITS):
        raise HostError(f"{where} unit is {unit!r}; known are {', '.join(TIME_UNITS)}.")
    return Clock(name, unit, _factor(table, where), _number(table.get("offset", 0.0), f"{where} offset"))


def _column(value: Any, where: str) -> Column:
    if isinstance(value, str):
        return Column(value)
    if not isinstance(value, dict) or not isinstance(value.get("name"), str):
        hint = " (a name with a dot needs quotation marks)" if isinstance(value, dict) else ""
        raise HostError(f'{where} must be a column of the log, or {{ name = "...", unit = "..." }}{hint}.')
    _known(value, _SIGNAL, where)
    for key in ("unit", "time"):
        if key in value and not isinstance(value[key], str):
            raise HostError(f"{where}: {key} is {value[key]!r}; it must be a text.")
    factor, offset = _factor(value, where), _number(value.get("offset", 0.0), f"{where}: offset")
    return Column(value["name"], value.get("unit"), factor, offset, value.get("time"))


def _known(table: dict[str, Any], keys: tuple[str, ...], where: str) -> None:
    unknown = next((key for key in table if key not in keys), None)
    if unknown is not None:
        raise HostError(f"{where} has '{unknown}'; known are {', '.join(keys)}.")


def _factor(table: dict[str, Any], where: str) -> float:
    factor = _number(table.get("factor", 1.0), f"{where}: factor")
    if factor == 0.0:
        raise HostError(f"{where}: factor is 0; it must be another number.")
    return factor


def _number(value: Any, where: str) -> float:
    if not is_finite(value):
        raise HostError(f"{where} is {value!r}; it must be a finite number.")
    return float(value)
