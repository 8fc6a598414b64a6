"""Aliases: ALi3 names for variables of an FMU of another program, with factor and offset."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hosts.common.numbers import Value
from hosts.fmu.aliases.derived_variable import Derived


@dataclass(frozen=True)
class Alias:
    """The alias of one variable: value in the FMU = factor * ALi3 value + offset."""

    name: str
    """ALi3 name."""
    fmu_name: str
    """Name in the FMU."""
    factor: float = 1.0
    offset: float = 0.0

    def to_fmu(self, value: Any) -> Any:
        """A start value, converted to the unit of the FMU; texts are unchanged."""
        return value if self._keeps(value) else self.factor * value + self.offset

    def from_fmu(self, value: Value) -> Value:
        """A start value in the unit of the FMU, converted; texts are unchanged."""
        return value if self._keeps(value) else (float(value) - self.offset) / self.factor

    def _keeps(self, value: object) -> bool:
        return isinstance(value, (str, bool)) or (self.factor, self.offset) == (1.0, 0.0)


@dataclass(frozen=True)
class Aliases:
    """The aliases of a file."""

    aliases: tuple[Alias, ...] = ()
    constants: Mapping[str, float] = field(default_factory=dict)
    """Constants of the car, by ALi3 names."""
    derived: tuple[Derived, ...] = ()
    """Derived variables, each after those that it needs."""
    missing: Mapping[str, str] = field(default_factory=dict)
    """ALi3 names in the file that this FMU cannot provide, each with a sentence on the reason."""

    def names(self, fmu_names: Sequence[str]) -> tuple[str, ...]:
        """ALi3 names of variables; a variable without an alias keeps its name."""
        by_name = {alias.fmu_name: alias.name for alias in self.aliases}
        return tuple(by_name.get(name, name) for name in fmu_names)

    @property
    def of_record(self) -> dict[str, tuple[str, float, float]]:
        """ALi3 name, factor and offset by the name in the FMU, as in records of runs."""
        return {alias.fmu_name: (alias.name, alias.factor, alias.offset) for alias in self.aliases}

    def why_missing(self, name: str) -> str:
        """A sentence on why this FMU lacks an ALi3 name; empty if it is not in the file."""
        return self.missing.get(name, "")

    def scales(self, fmu_names: Sequence[str]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Factors and offsets of variables. `fmu_names`: n names in the FMU.

        Returns `factors` and `offsets`, shape (n,): ALi3 value = (value in the FMU - offset) / factor.
        """
        by_name = {alias.fmu_name: alias for alias in self.aliases}
        results = [by_name.get(name, Alias(name, name)) for name in fmu_names]
        return np.array([a.factor for a in results]), np.array([a.offset for a in results])

    def inputs(self, values: Mapping[str, tuple[float, float]]) -> dict[str, tuple[float, float]]:
        """Values and rates of inputs, converted from ALi3 names and units to those of the FMU."""
        by_name = {alias.name: alias for alias in self.aliases}
        results = {}
        for name, (value, rate) in values.items():
            alias = by_name.get(name, Alias(name, name))
            results[alias.fmu_name] = (alias.factor * value + alias.offset, abs(alias.factor) * rate)
        return results

    def fmu_values(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """Start values, converted from ALi3 names and units to those of the FMU; texts are unchanged."""
        by_name = {alias.name: alias for alias in self.aliases}
        aliased = ((by_name.get(name, Alias(name, name)), value) for name, value in values.items())
        return {alias.fmu_name: alias.to_fmu(value) for alias, value in aliased}

    def ali3_values(self, values: Mapping[str, Value]) -> dict[str, Value]:
        """Start values, converted from names and units of the FMU to those of ALi3; texts are unchanged."""
        by_name = {alias.fmu_name: alias for alias in self.aliases}
        aliased = ((by_name.get(name, Alias(name, name)), value) for name, value in values.items())
        return {alias.name: alias.from_fmu(value) for alias, value in aliased}
