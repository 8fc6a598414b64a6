"""What the loop of a run needs of an FMU, made by hand."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np


class MadeFmu:
    """One whose steps are those of a subclass; all outputs have the value of `output`.

    `names_of`: names of its variables by causality; `unit`: of all of them.
    """

    def __init__(self, names_of: Mapping[str, Sequence[str]], unit: str, follows_slopes: bool) -> None:
        self.derived = ()
        self.path, self.messages, self.follows_slopes = Path("made.fmu"), list[str](), follows_slopes
        self.tunable = list[str]()
        self._names = {causality: list(names) for causality, names in names_of.items()}
        self.variables = {
            n: SimpleNamespace(type="Real", variability="continuous", causality=c, unit=unit)
            for c, names in self._names.items()
            for n in names
        }
        self.table = {n: SimpleNamespace(low=-np.inf, high=np.inf) for n in self.variables}
        self.given, self.slopes = dict.fromkeys(self._names["input"], 0.0), dict.fromkeys(self._names["input"], 0.0)
        self.output = 0.0

    def names(self, causality: str) -> list[str]:
        return self._names[causality]

    def initialise(self, start: dict[str, Any], start_time: float = 0.0) -> None:
        self.given.update({n: value for n, value in start.items() if n in self.given})

    def start_values(self, names: Sequence[str]) -> np.ndarray:
        return np.zeros(len(names))

    def setter(self, names: Sequence[str]) -> Callable[[Sequence[float]], None]:
        return lambda values: self.given.update(zip(names, values, strict=True))

    def slope_setter(self, names: Sequence[str]) -> Callable[[Sequence[float]], None]:
        return lambda values: self.slopes.update(zip(names, values, strict=True))

    def reader(self, names: Sequence[str]) -> Callable[[np.ndarray], None]:
        return lambda into: into.fill(self.output)
