"""Limits that a user gives to measures, in the table ``[limits]`` of a TOML file."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, ValidationError, model_validator

from ali3.near_names import did_you_mean
from ali3.reading import read_toml
from ali3.typed_sentences import Sentences
from hosts.common.errors import HostError
from hosts.common.numbers import or_null
from hosts.common.units import conversion
from hosts.measures.measure import Limit


class LimitEntry(BaseModel):
    """Least and largest value of a measure; a list of two numbers stands for both."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)

    min: FiniteFloat | None = Field(default=None, title="a number, the least value")
    max: FiniteFloat | None = Field(default=None, title="a number, the largest value")
    unit: str | None = Field(default=None, title="the unit of these numbers, as text; default: that of the measure")

    @model_validator(mode="before")
    @classmethod
    def _as_table(cls, entry: object) -> object:
        if isinstance(entry, list) and len(entry) != 2:
            raise ValueError(f"it is a list of {len(entry)}; a list has the least and the largest value")
        if not isinstance(entry, (list, dict)):
            raise ValueError(f"it is {entry}; it must be a table with min or max, or a list of both")
        return dict(zip(("min", "max"), entry, strict=True)) if isinstance(entry, list) else entry

    @model_validator(mode="after")
    def _check_order(self) -> LimitEntry:
        if self.min is None and self.max is None:
            raise ValueError("it needs min or max, or both")
        if self.min is not None and self.max is not None and self.min > self.max:
            raise ValueError(f"its limits are {self.min:g} and {self.max:g}; the lower one comes first")
        return self


class _LimitsFile(BaseModel):
    """A file with a table ``[limits]``; other tables, as of a study file, are ignored."""

    model_config = ConfigDict(extra="ignore", frozen=True, strict=True)

    limits: dict[str, LimitEntry] = Field(min_length=1, title="a table, min and max by names of measures")


def read_limits(file: Path) -> dict[str, LimitEntry]:
    """Read the table ``[limits]`` of a file, which may be a study file.

    Raises `HostError` if there is no such table, or an entry is wrong, with the key, its value and a remedy.
    """
    record = read_toml(file, HostError)
    try:
        return _LimitsFile.model_validate(record).limits
    except ValidationError as error:
        raise HostError(f"{file}: {Sentences(_LimitsFile, record).of(error)[0]}") from None


def limits_of(entries: Mapping[str, LimitEntry], columns: Mapping[str, str], source: Path) -> dict[str, Limit]:
    """Limits by the columns of measures, in the units of the measures.

    `entries`: entries of the file; a name may omit the prefix of its test if it is unique without; `columns`: units of
    all measures. Raises `HostError` if there is no such measure, or the unit is one of another quantity.
    """
    results: dict[str, Limit] = {}
    for name, entry in entries.items():
        label = f"{source}: limits.'{name}'"
        column = column_of(name, columns, label)
        if column in results:
            raise HostError(f"{label} and another limit are both of '{column}'; give one of them.")
        factor = 1.0 if entry.unit is None else conversion(entry.unit, columns[column], f"{label}.unit")
        low = -math.inf if entry.min is None else factor * entry.min
        high = math.inf if entry.max is None else factor * entry.max
        results[column] = Limit(source.name, low, high)
    return results


def limits_record(entries: Mapping[str, LimitEntry], columns: Mapping[str, str], source: Path) -> dict[str, Any]:
    """Limits by the columns of measures for JSON, with None if there is no limit; see `limits_of`."""
    return {
        column: {"min": or_null(limit.lowest), "max": or_null(limit.highest), "unit": columns[column]}
        for column, limit in limits_of(entries, columns, source).items()
    }


def column_of(name: str, columns: Mapping[str, str], label: str) -> str:
    """The column of a name with or without its prefix. Raises `HostError` if there is none, or several."""
    matches = [name] if name in columns else [c for c in columns if c.endswith(f".{name}")]
    if len(matches) == 1:
        return matches[0]
    if matches:
        raise HostError(f"{label}: it could be {' or '.join(matches)}; give the whole name.")
    hint = did_you_mean(name, columns, f"there are {', '.join(list(columns)[:8]) or 'none'}")
    raise HostError(f"{label}: there is no measure '{name}'{hint}")
