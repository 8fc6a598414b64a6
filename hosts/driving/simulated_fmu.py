"""What the co-simulation loop needs of an FMU: by its own names, or through aliases."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

import numpy as np
from fmpy.model_description import ModelDescription, ScalarVariable
from numpy.typing import NDArray

from hosts.common.numbers import Value
from hosts.fmu.variables import Variable

if TYPE_CHECKING:
    from hosts.fmu.aliases.alias import Aliases


class VariableTable(Protocol):
    """Variables with their ranges, by name."""

    def __getitem__(self, name: str, /) -> Variable: ...


class SimulatedFmu(Protocol):
    """See `hosts.fmu.fmu.Fmu`, whose attributes and methods these are."""

    path: Path
    description: ModelDescription
    variables: dict[str, ScalarVariable]
    messages: list[str]
    aliases: Aliases | None
    """Through which it is seen."""

    @property
    def table(self) -> VariableTable: ...
    @property
    def tunable(self) -> list[str]: ...
    def names(self, causality: str) -> list[str]: ...
    def initialise(self, start: Mapping[str, Value], start_time: float = 0.0) -> None: ...
    def reset(self) -> None: ...
    def setter(self, names: Sequence[str]) -> Callable[[Sequence[float]], None]: ...
    def reader(self, names: Sequence[str]) -> Callable[[NDArray[np.float64]], None]: ...
    @property
    def follows_slopes(self) -> bool: ...
    def slope_setter(self, names: Sequence[str]) -> Callable[[Sequence[float]], None]: ...
    def step(self, time: float, step: float) -> None: ...
    def restore_bytes(self, content: bytes) -> None: ...
    def start_values(self, names: Iterable[str]) -> NDArray[np.float64]: ...
    def constants(self) -> dict[str, float]: ...
