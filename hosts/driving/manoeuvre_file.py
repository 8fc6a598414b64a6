"""Manoeuvres as files: one in TOML with all that belongs to it, or a plain CSV file."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, ValidationError, model_validator

from ali3.message_text import brief
from ali3.near_names import did_you_mean
from ali3.reading import LARGEST_TEXT, is_file, missing_file_text, read_toml
from ali3.typed_sentences import Sentences
from hosts.common.errors import HostError
from hosts.common.numbers import Value, text_of
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.manoeuvre_table import check_times, read_table
from hosts.driving.manoeuvres import FOLDER, manoeuvre_names
from hosts.driving.pilots.pilot import ACTS
from hosts.driving.run_record import read_state

SUFFIXES = (".toml", ".csv")
"""Suffixes of files of manoeuvres."""


def read_manoeuvre(manoeuvre: str, stop_time: float | None = None) -> Manoeuvre:
    """Read a manoeuvre by name or path.

    `manoeuvre`: name of a manoeuvre of the package, or a file in TOML or CSV; see `read_table`. A TOML file has
    ``stop_time`` in s, ``[start]`` values, settings of a ``[driver]``, ``[inputs]`` with a list of numbers for ``time``
    and each input, ``held``, a list of those that keep a value up to the next time, ``find_throttle``, true
    where the throttle is the one that holds the speed of the start, and a ``[state]`` of the FMU to begin with:
    ``file`` beside it, ``time``. `stop_time`: in place of its own, s. Raises `HostError` with the line or
    key and the reason.
    """
    path = Path(manoeuvre)
    _check_name(manoeuvre)
    if path.suffix not in SUFFIXES:
        path = next(p for p in (FOLDER / f"{manoeuvre}{suffix}" for suffix in SUFFIXES) if is_file(p))
    if path.suffix == ".toml":
        table = _read_toml(path)
    else:
        if not is_file(path):
            raise HostError(missing_file_text(path))
        table = read_table(path)
    if stop_time is not None:
        return replace(table, stop_time=stop_time)
    if not table.stop_time > 0.0:
        raise HostError(f"{path} does not say how long it lasts; give a later time in the table or a stop_time.")
    return table


def _check_name(manoeuvre: str) -> None:
    """Raise `HostError` with similar names if a text is neither a file nor the name of a manoeuvre.

    `manoeuvre`: see `read_manoeuvre`.
    """
    if Path(manoeuvre).suffix in SUFFIXES or manoeuvre in (names := manoeuvre_names()):
        return
    near = did_you_mean(manoeuvre, names, f"give a file.toml, a file.csv or one of: {', '.join(names)}")
    raise HostError(f"There is no manoeuvre '{manoeuvre}'{near}")


class _StrictModel(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)


class _State(_StrictModel):
    file: str = Field(title="the name of a file beside it")
    time: FiniteFloat = Field(title="a number, s")


class _ManoeuvreFile(_StrictModel):
    stop_time: FiniteFloat | None = Field(default=None, gt=0.0, title="a positive number, s")
    held: list[str] = Field(default=[], title="a list of names of [inputs]")
    find_throttle: bool = Field(default=False, title="true or false")
    start: dict[str, Value] = Field(default={}, title="a table, values by names of variables")
    driver: dict[str, Value] = Field(default={}, title="a table, settings of a driver")
    inputs: dict[str, Annotated[list[FiniteFloat], Field(min_length=1, title="a list of numbers")]] = Field(
        default={}, title="a table with lists of numbers: time, and inputs"
    )
    state: _State | None = Field(default=None, title="a table with the name of a file, and a time")

    @model_validator(mode="after")
    def _check_columns(self) -> _ManoeuvreFile:
        if self.inputs and ("time" not in self.inputs or len(self.inputs) < 2):
            raise ValueError(f"[inputs] has {', '.join(self.inputs)}; it must have time and inputs")
        time = self.inputs.get("time", [])
        for name, column in self.inputs.items():
            if len(column) != len(time):
                raise ValueError(f"inputs: '{name}' has {len(column)} values where time has {len(time)}")
        if back := next(((a, b) for a, b in pairwise(time) if b < a), None):
            raise ValueError(f"inputs: time goes back from {back[0]:g} s to {back[1]:g} s")
        if odd := next((name for name in self.held if name == "time" or name not in self.inputs), None):
            raise ValueError(f"held has '{odd}'; it must be a list of names of [inputs]")
        if self.driver and (driven := [name for name in ACTS if name in self.inputs]):
            raise ValueError(f"[inputs] has {', '.join(driven)}, which the driver sets; remove them, or [driver]")
        if self.find_throttle and (self.driver or "throttle" in self.inputs):
            conflict = "[driver]" if self.driver else "throttle in [inputs]"
            raise ValueError(f"with find_throttle there is no {conflict}")
        return self


def _read_toml(path: Path) -> Manoeuvre:
    # TOML reads ``initial.speed = 1`` as a table ``initial``
    content = {
        key: _flattened(value, f"{path}, [{key}]") if isinstance(value, dict) else value
        for key, value in read_toml(path, HostError, largest=LARGEST_TEXT).items()
    }
    try:
        file = _ManoeuvreFile.model_validate(content)
    except ValidationError as error:
        raise HostError(f"{path}: {Sentences(_ManoeuvreFile, content).of(error)[0]}") from None
    inputs = {name: np.array(column, dtype=np.float64) for name, column in file.inputs.items()}
    time = inputs.pop("time", np.zeros(0))
    if len(time):
        check_times(time.tolist(), path)
    stop_time = file.stop_time or (float(time[-1]) if len(time) else math.nan)
    driver = {name: value if isinstance(value, str) else text_of(value) for name, value in file.driver.items()}
    state: tuple[bytes | None, float] = None, 0.0
    if file.state is not None:
        state = read_state(path.parent, file.state.file, str(path)), file.state.time
    held = frozenset(file.held)
    return Manoeuvre(path.stem, time, inputs, stop_time, file.start, driver, *state, held, file.find_throttle)


def _flattened(table: Mapping[str, Any], where: str) -> dict[str, Any]:
    """Values by the whole names of their keys. Raises `HostError` if one is given twice, as ``a.b`` and ``"a.b"``."""
    values = list(_named_values(table))
    counts = Counter(name for name, _ in values)
    if repeated := next((name for name, count in counts.items() if count > 1), None):
        raise HostError(f"{where}: {brief(repeated)} is given twice.")
    return dict(values)


def _named_values(table: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    for key, value in table.items():
        if isinstance(value, dict):
            yield from ((f"{key}.{rest}", inner) for rest, inner in _named_values(value))
        else:
            yield key, value
