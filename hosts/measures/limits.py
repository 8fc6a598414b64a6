"""Limits that a user gives to measures, in the table ``[limits]`` of a TOML file."""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from ali3.near_names import did_you_mean
from ali3.reading import read_toml
from ali3.typed_sentences import Sentences
from hosts.common.errors import HostError
from hosts.common.numbers import or_null
from hosts.common.units import conversion
from hosts.measures.limit_entry import LimitEntry
from hosts.measures.measure import Limit


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
