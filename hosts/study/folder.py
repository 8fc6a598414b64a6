"""The folder of the results of a study, and the types of its record ``study.json``."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
from collections.abc import Mapping
from itertools import chain
from pathlib import Path
from typing import Annotated, Any, Literal, TypeAlias

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, ValidationError, model_validator

from ali3.archives import LARGEST_ARCHIVE
from ali3.columns import some_of
from ali3.files import atomic_file, make_folder, write_bytes, write_json
from ali3.json_reading import read_json
from ali3.message_text import VALUE, one_line
from ali3.reading import missing_file_text, read_bytes
from ali3.typed_sentences import Sentences
from hosts.common.errors import HostError
from hosts.study.study_file import SamplingEntry, Setting, SignalsEntry

RECORD = "study.json"
_HASH = r"^[0-9a-f]{64}$"
_FILE_NAME = r"^[^/\\:\x00-\x1f]*[^/\\:\x00-\x1f.][^/\\:\x00-\x1f]*$"
_FORMS = {_HASH: "a SHA-256 hash, 64 hexadecimal digits", _FILE_NAME: "the name of a file in this folder"}
_VARIABLE_KEYS = ("versions", "file", "units", "measures", "limits", "created", "reuse")
"""Keys of the record that may differ when a study is resumed, or that follow from others."""
_LABELS = {
    "guid": "the GUID of the FMU",
    "fmu_sha256": "the content of the FMU",
    "program": "the program that makes the runs",
    "points_sha256": "the points that are drawn",
    "measured": "the measures",
}
_MAX_DIFFERENCES = 3

Hash: TypeAlias = Annotated[str, Field(pattern=_HASH)]


class _Table(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)


class _Parameter(_Table):
    kind: Literal["Real", "Integer", "Enumeration", "Boolean", "String"] = Field(
        title="Real, Integer, Enumeration, Boolean or String"
    )
    unit: str | None = Field(title="text")
    low: FiniteFloat | None = Field(default=None, title="a number")
    high: FiniteFloat | None = Field(default=None, title="a number")
    log: bool = Field(default=False, title="true or false")
    values: list[Setting] = Field(default=[], title="a list of values")


class _Manoeuvre(BaseModel):
    model_config = ConfigDict(extra="allow", frozen=True, strict=True)  # with the entries of the study file

    name: str = Field(title="text")
    step: FiniteFloat | None = Field(gt=0.0, title="a positive number, s")
    sha256: Hash


class _Limit(_Table):
    min: FiniteFloat | None = Field(title="a number")
    max: FiniteFloat | None = Field(title="a number")
    unit: str = Field(title="text")


class StudyRecord(_Table):
    """The record of a study: its plan, and the versions of the programs."""

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
    def _check_consistency(self) -> StudyRecord:
        jobs = len(self.manoeuvres)
        if self.runs != self.points * jobs:
            raise ValueError(f"it has {self.runs} runs where {self.points} points of {jobs} manoeuvres must be")
        names = [*self.parameters, *self.measures]
        if len(set(names)) < len(names):
            raise ValueError("a parameter and a measure have the same name")
        return self


def read_record(folder: Path) -> dict[str, Any] | None:
    """The record of the study in a folder; None if there is none. Raises `HostError` if the record is damaged."""
    file = folder / RECORD
    if not file.exists():
        return None
    record = read_json(file, HostError)
    if not isinstance(record, dict):
        raise HostError(f"{file} is damaged: it is not a JSON object.")
    try:
        StudyRecord.model_validate(record)
    except ValidationError as error:
        raise HostError(f"{file} is damaged: {Sentences(StudyRecord, record, forms=_FORMS).of(error)[0]}") from None
    return record


RUNS, SIGNALS, ANALYSIS, REPEAT = _WRITTEN = ("runs", "signals", "analysis", "repeat")


def check_no_link(folder: Path) -> None:
    """Raise `HostError` if a path in a folder of results is a link, through which another file would be overwritten."""
    for path in chain(folder.glob("*"), *((folder / name).rglob("*") for name in _WRITTEN)):
        if path.is_symlink():
            raise HostError(f"{path} is a link; nothing is written through it. Remove it, or give another --out.")


def fmu_of_folder(folder: Path, record: Mapping[str, Any]) -> Path:
    """The FMU in a folder of results. Raises `HostError` if it is missing, or is not the FMU of the rows."""
    file = folder / str(record["fmu"])
    if not file.is_file():
        raise HostError(f"{missing_file_text(file)} It made the runs of this study; put it back.")
    sha256 = hashlib.sha256(read_bytes(file, LARGEST_ARCHIVE, HostError)).hexdigest()
    if sha256 != record["fmu_sha256"]:
        raise HostError(
            f"{file} is another FMU than the one that made the rows: its SHA-256 is {sha256[:12]}..., that in {RECORD} "
            f"is {record['fmu_sha256'][:12]}...; it is not run. Put the FMU back that was there."
        )
    return file


def begin_study(folder: Path, record: Mapping[str, Any], study_file: bytes, fmu: Path) -> None:
    """Write study file, FMU and record into the folder of a study; the record last, as it marks a complete folder."""
    write_bytes(folder / "study.toml", study_file)
    with atomic_file(folder / fmu.name) as temporary:
        shutil.copyfile(fmu, temporary)
    make_folder(folder / RUNS)
    write_record(folder, record)


def write_record(folder: Path, record: Mapping[str, Any]) -> None:
    """Write the record of the study."""
    write_json(folder / RECORD, record)


def free_space(folder: Path) -> int:
    """Free space of the disk of a folder, which need not exist, bytes."""
    existing = next(p for p in (folder.absolute(), *folder.absolute().parents) if p.exists())
    return shutil.disk_usage(existing).free


def sync(file: Path) -> None:
    """Flush a file to the disk, so that it is not empty if power fails after it is renamed."""
    with file.open("rb+") as stream:
        os.fsync(stream.fileno())


def check_same(folder: Path, earlier: Mapping[str, Any], now: Mapping[str, Any]) -> None:
    """Raise `HostError` with the differences if a folder holds another study than the one to be resumed."""
    new = {key: json.loads(json.dumps(value)) for key, value in now.items()}
    keys = [key for key in dict.fromkeys((*_LABELS, *earlier, *new)) if key not in _VARIABLE_KEYS]
    differences = [key for key in keys if earlier.get(key) != new.get(key)]
    if not differences:
        return
    # Differences that follow from others are not reported.
    if "guid" in differences:
        differences = [key for key in differences if key != "fmu_sha256"]
    if len(differences) > 1:
        differences = [key for key in differences if key not in ("points_sha256", "points", "runs")]
    message = some_of(
        (_difference_text(key, earlier.get(key), new.get(key)) for key in differences), _MAX_DIFFERENCES, "; "
    )
    raise HostError(
        f"{folder} holds another study, whose rows stay as they are: {message}. Put it back as it was, or give another "
        "--out."
    )


def _difference_text(key: str, earlier: Any, now: Any) -> str:
    if isinstance(earlier, dict) and isinstance(now, dict):
        inner = next(k for k in dict.fromkeys((*earlier, *now)) if earlier.get(k) != now.get(k))
        if key in _LABELS:
            return f"{_LABELS[key]} '{inner}' changed"
        return _difference_text(
            f"{key}.'{inner}'" if "." in inner else f"{key}.{inner}", earlier.get(inner), now.get(inner)
        )
    if isinstance(earlier, list) and isinstance(now, list) and len(earlier) == len(now):
        number = next(k for k in range(len(now)) if earlier[k] != now[k])
        return _difference_text(f"{key}[{number + 1}]", earlier[number], now[number])
    if key.rpartition(".")[2] in ("sha256", "fmu_sha256", "points_sha256", "program", "aliases"):
        return f"{_LABELS.get(key, key)} changed"
    earlier_text, now_text = (
        "not given" if v is None else one_line(json.dumps(v, ensure_ascii=False), VALUE) for v in (earlier, now)
    )
    return f"{_LABELS.get(key, key)} was {earlier_text} and is {now_text}"


def update_limits(folder: Path, earlier: dict[str, Any], limits: Mapping[str, Any], content: bytes) -> dict[str, Any]:
    """The record of earlier runs with new limits, on which runs do not depend; written if the limits differ.

    `content`: content of the study file.
    """
    if earlier.get("limits", {}) == limits:
        return earlier
    record = {**earlier, "limits": dict(limits)}
    write_bytes(folder / "study.toml", content)
    write_record(folder, record)
    return record
