"""The study file; `hosts.study.plan` checks it against the FMU."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Literal, TypeAlias

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, ValidationError, model_validator

from ali3.reading import LARGEST_TOML, read_bytes, toml_of
from ali3.typed_sentences import Sentences
from hosts.common.errors import HostError
from hosts.measures.limits import LimitEntry

METHODS = ("grid", "latin_hypercube", "sobol", "saltelli", "table")

Setting: TypeAlias = bool | int | FiniteFloat | str
Name: TypeAlias = Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_.\- ]*$", max_length=100)]
NAME_WORDS = "up to 100 letters, digits, spaces, dots, minus signs and underscores, a letter first"


class _Table(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)


class ParameterEntry(_Table):
    """The variation of a parameter of the FMU."""

    range: list[FiniteFloat] | None = Field(default=None, min_length=2, max_length=2, title="two numbers, low and high")
    values: list[Setting] | None = Field(default=None, min_length=1, title="a list of at least one value")
    count: int | None = Field(default=None, ge=1, title="a whole number, how many values of the range a grid has")
    unit: str | None = Field(default=None, title="the unit of the FMU or a display unit of it, as text")
    log: bool = Field(default=False, title="true or false: whether the range is divided by the logarithm")

    @model_validator(mode="after")
    def _check_consistency(self) -> ParameterEntry:
        if self.range is not None and self.values is not None:
            raise ValueError("it has a range and values; give one of them")
        if self.range is not None and not self.range[0] < self.range[1]:
            raise ValueError(f"its range is {self.range[0]:g} to {self.range[1]:g}; the lower end comes first")
        if self.log and self.range is None:
            raise ValueError("log needs a range")
        if self.count is not None and self.range is None:
            raise ValueError("count needs a range")
        return self


class ManoeuvreEntry(_Table):
    """A manoeuvre or a test at each point."""

    name: Name | None = Field(default=None, title=NAME_WORDS)
    manoeuvre: str | None = Field(default=None, title="a manoeuvre of the command run: its name or a file")
    test: str | None = Field(default=None, title="the name of a test of the command catalogue")
    settings: dict[str, FiniteFloat] = Field(default_factory=dict, title="numbers by the name of a test's setting")
    measures: list[str] | None = Field(default=None, min_length=1, title="a list of at least one measure of a test")
    stop_time: FiniteFloat | None = Field(default=None, gt=0.0, title="a positive number, s")
    start: dict[str, Setting] = Field(default_factory=dict, title="values by names of parameters or inputs")

    @model_validator(mode="after")
    def _check_consistency(self) -> ManoeuvreEntry:
        if self.manoeuvre is not None and self.test is not None:
            raise ValueError("it has a manoeuvre and a test; give one of them")
        if self.manoeuvre is None and self.test is None and self.stop_time is None:
            raise ValueError("it needs a manoeuvre, a test, or a stop_time (for constant inputs)")
        if self.test is None and self.settings:
            raise ValueError("settings need a test")
        if self.test is None and self.measures is not None:
            raise ValueError("measures here are those of a test that are kept; those of manoeuvres are in [measures]")
        if self.test is not None and self.stop_time is not None:
            raise ValueError("a test ends by itself; leave the stop_time out")
        return self


class SamplingEntry(_Table):
    """The sampling of the parameters."""

    method: Literal["grid", "latin_hypercube", "sobol", "saltelli", "table"] = Field(
        default="grid", title=f"one of {', '.join(METHODS)}"
    )
    runs: int | None = Field(default=None, ge=1, le=2**30, title="a positive whole number of points")
    seed: int = Field(default=0, ge=0, lt=2**63, title="a whole number from 0")
    file: str | None = Field(default=None, title="a CSV file whose heading names parameters")

    @model_validator(mode="after")
    def _check_consistency(self) -> SamplingEntry:
        is_random = self.method in ("latin_hypercube", "sobol", "saltelli")
        if is_random and self.runs is None:
            raise ValueError(f"the method {self.method} needs the number of points, runs")
        if not is_random and self.runs is not None:
            raise ValueError(f"the method {self.method} gives its number of points itself; leave runs out")
        if (self.method == "table") != (self.file is not None):
            raise ValueError("the method table, and no other, needs a file")
        return self


class SignalsEntry(_Table):
    """Signals that are stored over time."""

    names: list[str] = Field(min_length=1, title="a list of at least one name of an input or output")
    interval: FiniteFloat = Field(gt=0.0, title="a positive number, s")


class StudyFile(_Table):
    """The content of a study file."""

    name: Name | None = Field(default=None, title=NAME_WORDS)
    fmu: str | None = Field(default=None, title="the path of an FMU")
    car: str | None = Field(default=None, title="a car of the package by its name, or a car file")
    aliases: str | None = Field(default=None, title="an alias file, or the name of one of the package")
    step: FiniteFloat | None = Field(default=None, gt=0.0, title="a positive number, s")
    time_limit: FiniteFloat | None = Field(default=None, gt=0.0, title="a positive number, s, that a run may take")
    start: dict[str, Setting] = Field(default_factory=dict, title="values by names of parameters or inputs")
    manoeuvres: list[ManoeuvreEntry] = Field(min_length=1, title="at least one table [[manoeuvres]]")
    sampling: SamplingEntry = Field(default=SamplingEntry(), title="a table")
    parameters: dict[str, ParameterEntry] = Field(default_factory=dict, title="a table for each parameter")
    signals: SignalsEntry | None = Field(default=None, title="a table with names and interval")
    measures: dict[Name, str] = Field(default_factory=dict, title="what is computed, as text, by its name")
    limits: dict[str, LimitEntry] = Field(default_factory=dict, title="a table, min and max by names of measures")

    @model_validator(mode="after")
    def _check_consistency(self) -> StudyFile:
        if (self.fmu is None) == (self.car is None):
            raise ValueError("it needs fmu or car, one of them")
        if self.sampling.method != "table":
            for name, entry in self.parameters.items():
                if entry.range is None and entry.values is None:
                    raise ValueError(f"parameters.'{name}' needs a range or values")
                if self.sampling.method == "grid" and entry.range is not None and entry.count is None:
                    raise ValueError(f"parameters.'{name}' needs a count, how many values of its range the grid has")
                if self.sampling.method != "grid" and entry.count is not None:
                    raise ValueError(f"parameters.'{name}' has a count, which only the method grid uses")
        duplicates = sorted(set(self.start) & set(self.parameters))
        if duplicates:
            raise ValueError(f"'{duplicates[0]}' is a parameter and in [start]; give it once")
        return self


def read_study_file(file: Path) -> tuple[StudyFile, bytes]:
    """Read a study file. Returns the study and the content of the file.

    Raises `HostError` with the key, its value and a remedy.
    """
    content = read_bytes(file, LARGEST_TOML, HostError)
    record = toml_of(content, HostError, str(file))
    try:
        return StudyFile.model_validate(record), content
    except ValidationError as error:
        raise HostError(
            f"{file}: {Sentences(StudyFile, record, names=NAME_WORDS, place=_key_path).of(error)[0]}"
        ) from None


def _key_path(path: Sequence[str]) -> str:
    """The path of a key as text, with indices in lists from 1."""
    text = ""
    for key in path:
        name = key if key.replace("_", "").isalnum() else f"'{key}'"
        text += f"[{int(key) + 1}]" if key.isdigit() else f".{name}" if text else name
    return text
