"""What is known of a study, as its folder holds it: the types of ``study.json``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal, TypeAlias

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from ali3.json_reading import read_json
from ali3.typed_sentences import Sentences
from hosts.common.errors import HostError
from hosts.measures.limit_entry import Number
from hosts.study.study_file import SamplingEntry, Setting, SignalsEntry

RECORD = "study.json"
_HASH = r"^[0-9a-f]{64}$"
_FILE_NAME = r"^[^/\\:\x00-\x1f]*[^/\\:\x00-\x1f.][^/\\:\x00-\x1f]*$"
_FORMS = {_HASH: "a SHA-256 hash, 64 hexadecimal digits", _FILE_NAME: "the name of a file in this folder"}

Hash: TypeAlias = Annotated[str, Field(pattern=_HASH)]


class _Part(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)


class _Parameter(_Part):
    kind: Literal["Real", "Integer", "Enumeration", "Boolean", "String"] = Field(
        title="Real, Integer, Enumeration, Boolean or String"
    )
    unit: str | None = Field(title="text")
    low: Number | None = Field(default=None, title="a number")
    high: Number | None = Field(default=None, title="a number")
    log: bool = Field(default=False, title="true or false")
    values: list[Setting] = Field(default=[], title="a list of values")


class _Manoeuvre(BaseModel):
    model_config = ConfigDict(extra="allow", frozen=True, strict=True)  # with what the study file says of it

    name: str = Field(title="text")
    step: Number | None = Field(gt=0.0, title="a positive number, s")
    sha256: Hash


class _Limit(_Part):
    min: Number | None = Field(title="a number")
    max: Number | None = Field(title="a number")
    unit: str = Field(title="text")


class StudyRecord(_Part):
    """What was run, by which program."""

    name: str = Field(title="text")
    guid: str = Field(title="text")
    model: str = Field(title="text")
    fmu: str = Field(pattern=_FILE_NAME)
    fmu_sha256: Hash
    car: str | None = Field(default=None, title="text")
    seed: int = Field(ge=0, lt=2**63, title="a whole number from 0")
    sampling: SamplingEntry = Field(title="a table")
    parameters: dict[str, _Parameter] = Field(title="a table for each parameter")
    manoeuvres: list[_Manoeuvre] = Field(min_length=1, title="a list of at least one table")
    start: dict[str, Setting] = Field(title="values by names")
    measures: dict[str, str] = Field(title="units by names of measures")
    measured: dict[str, str] = Field(title="text by names of measures")
    signals: SignalsEntry | None = Field(title="a table with names and interval")
    aliases: Hash | None
    points: int = Field(ge=1, lt=2**40, title="a positive whole number")
    runs: int = Field(ge=1, lt=2**40, title="a positive whole number")
    points_sha256: Hash
    units: dict[str, str] = Field(title="text by names of columns")
    versions: dict[str, str] = Field(title="text by names of packages")
    program: Hash
    file: str = Field(title="the path of the study file")
    limits: dict[str, _Limit] = Field(default={}, title="a table for each limit")

    @model_validator(mode="after")
    def _fits(self) -> StudyRecord:
        each = len(self.manoeuvres)
        if self.runs != self.points * each:
            raise ValueError(f"it has {self.runs} runs where {self.points} points of {each} manoeuvres must be")
        names = [*self.parameters, *self.measures]
        if len(set(names)) < len(names):
            raise ValueError("a parameter and a measure have the same name")
        return self


def read_record(folder: Path) -> dict[str, Any] | None:
    """What is known of the study in a folder; None where there is none. Raises `HostError`: the file is damaged."""
    file = folder / RECORD
    if not file.exists():
        return None
    record = read_json(file, HostError, finite=False)
    if not isinstance(record, dict):
        raise HostError(f"{file} is damaged: it is no JSON object.")
    try:
        StudyRecord.model_validate(record)
    except ValidationError as error:
        raise HostError(f"{file} is damaged: {Sentences(StudyRecord, record, forms=_FORMS).of(error)[0]}") from None
    return record
