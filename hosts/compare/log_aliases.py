"""The alias file of a log: the dialect of its table, its clock, and ALi3 names for its columns."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, FiniteFloat, ValidationError, model_validator

from ali3.reading import is_file, read_toml
from ali3.typed_sentences import Sentences
from hosts.common.errors import HostError

TIME_UNITS: Mapping[str, float | None] = {
    "s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0, "h": 3600.0, "epoch": 1.0, "epoch_ms": 1e-3,
    "epoch_us": 1e-6, "epoch_ns": 1e-9, "iso": None,
}  # fmt: skip
"""Seconds of a unit of time; None: texts such as ``2024-05-03T12:00:00.010``."""
_COLUMN = 'it must be a column of the log, or { name = "...", unit = "..." }'


def _not_zero(value: float) -> float:
    if value == 0.0:
        raise ValueError("it is 0; it must be another number")
    return value


class _Table(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)


class _Scaled(_Table):
    factor: Annotated[FiniteFloat, AfterValidator(_not_zero)] = Field(default=1.0, title="a finite number other than 0")
    offset: FiniteFloat = Field(default=0.0, title="a finite number")


class Column(_Scaled):
    """A column of the log: number in the log = factor * value in `unit` + offset."""

    name: str = Field(title="the name of a column")
    unit: str | None = Field(default=None, title="a unit as text")
    """None: the unit of the table's heading, otherwise that of the FMU."""
    time: str | None = Field(default=None, title="the name of a column")
    """Column of times of this column; None: that of the table."""

    @model_validator(mode="before")
    @classmethod
    def _named(cls, entry: Any) -> Any:
        if isinstance(entry, dict) and not isinstance(entry.get("name"), str):
            raise ValueError(f"{_COLUMN} (a name with a dot needs quotation marks)")
        if not isinstance(entry, (dict, str)):
            raise ValueError(_COLUMN)
        return {"name": entry} if isinstance(entry, str) else entry


class Clock(_Scaled):
    """The column of times: number in the log = factor * time in `unit` + offset."""

    name: str | None = Field(default=None, title="the name of a column")
    unit: str | None = Field(
        default=None, pattern=rf"^({'|'.join(TIME_UNITS)})$", title=f"one of {', '.join(TIME_UNITS)}"
    )


class Dialect(_Table):
    """The dialect of a CSV file; None: detected from its first lines."""

    delimiter: str | None = Field(default=None, min_length=1, max_length=1, title="one character")
    decimal: str | None = Field(default=None, min_length=1, max_length=1, title="one character")
    encoding: str | None = Field(default=None, title="a name such as utf-8 or latin-1")
    heading: int | None = Field(default=None, ge=1, title="the number of a line")
    """Number of the line of names, from 1."""
    units: int | None = Field(default=None, ge=0, title="the number of a line")
    """Number of the line of units, from 1; 0: there is none."""

    @model_validator(mode="after")
    def _differ(self) -> Dialect:
        for key, other_key in (("delimiter", "decimal"), ("heading", "units")):
            if (value := getattr(self, key)) is not None and value == getattr(self, other_key):
                raise ValueError(f"{key} and {other_key} are both {value!r}; they must differ")
        return self


class LogAliases(_Table):
    """The content of the alias file of a log; without one the columns have ALi3 names."""

    dialect: Dialect = Field(default=Dialect(), alias="file", title="a table")
    clock: Clock = Field(default=Clock(), alias="time", title="a table")
    columns: dict[str, Column] = Field(default_factory=dict, alias="signals", title="columns of the log by ALi3 names")
    _file: str = ""

    @property
    def file(self) -> str:
        """Its path."""
        return self._file


def read_log_aliases(file: Path) -> LogAliases:
    """Read the alias file of a log.

    `file`: TOML with tables ``[file]``, ``[time]`` and ``[signals]``; in the last ``"ALi3 name" = "column"`` or ``"ALi3
    name" = { name = "column", unit = "deg/s", factor = -1.0, offset = 0.0, time = "column of times" }``. Raises
    `HostError` with the file, the key and what would be right.
    """
    content = read_toml(file, HostError, f"The alias file {file}")
    try:
        result = LogAliases.model_validate(content)
    except ValidationError as error:
        raise HostError(f"{file}: {Sentences(LogAliases, content).of(error)[0]}") from None
    result._file = str(file)
    return result


def refuse_log_aliases(file: Path) -> None:
    """Raise `HostError` if the alias file of a log is given as that of an FMU."""
    tables = {field.alias for field in LogAliases.model_fields.values()}
    if is_file(file) and (content := read_toml(file)) and set(content) <= tables:
        raise HostError(f"{file} is the alias file of a log; --log-aliases takes it, --aliases that of the FMU.")
