"""Our names for variables of an FMU, with factor and offset."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hosts.common.numbers import Value
from hosts.fmu.aliases.derived_variable import Derived


@dataclass(frozen=True)
class Alias:
    """One variable: value of the FMU = factor * ours + offset."""

    ours: str
    theirs: str
    factor: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True)
class Aliases:
    """The aliases of a file."""

    aliases: tuple[Alias, ...] = ()
    constants: Mapping[str, float] = field(default_factory=dict)
    """By our names."""
    derived: tuple[Derived, ...] = ()
    """Each after those that it needs."""
    missing: Mapping[str, str] = field(default_factory=dict)
    """Our names that the file has and this FMU cannot have, and why, in a sentence."""

    def names(self, theirs: Sequence[str]) -> tuple[str, ...]:
        """Our names of variables; those without an alias keep theirs."""
        by_name = {alias.theirs: alias.ours for alias in self.aliases}
        return tuple(by_name.get(name, name) for name in theirs)

    def ours(self, theirs: Iterable[str]) -> set[str]:
        """All of our names that an FMU with these variables has, derived ones among them."""
        return {*self.names(tuple(theirs)), *(d.ours for d in self.derived)}

    @property
    def of_record(self) -> dict[str, tuple[str, float, float]]:
        """By the FMU's names ours, factor and offset, as records of runs have them: value of the FMU = factor * ours +
        offset."""
        return {a.theirs: (a.ours, a.factor, a.offset) for a in self.aliases}

    def why_missing(self, name: str) -> str:
        """Why this FMU does not have one of our names, in a sentence; empty where the file does not know it."""
        return self.missing.get(name, "")

    def scales(self, theirs: Sequence[str]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Factors and offsets of variables. `theirs`: n names.

        Returns `factors` and `offsets`, shape (n,): ours = (theirs - offset) / factor.
        """
        by_name = {alias.theirs: alias for alias in self.aliases}
        results = [by_name.get(name, Alias(name, name)) for name in theirs]
        return np.array([a.factor for a in results]), np.array([a.offset for a in results])

    def inputs(self, values: Mapping[str, tuple[float, float]]) -> dict[str, tuple[float, float]]:
        """Values and rates under our names as the FMU has them."""
        by_name = {alias.ours: alias for alias in self.aliases}
        results = {}
        for name, (value, rate) in values.items():
            alias = by_name.get(name, Alias(name, name))
            results[alias.theirs] = (alias.factor * value + alias.offset, abs(alias.factor) * rate)
        return results

    def values(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """Start values under our names as the FMU has them; texts stay as they are."""
        by_name = {alias.ours: alias for alias in self.aliases}
        results = {}
        for name, value in values.items():
            alias = by_name.get(name, Alias(name, name))
            plain = isinstance(value, (str, bool)) or (alias.factor, alias.offset) == (1.0, 0.0)
            results[alias.theirs] = value if plain else alias.factor * value + alias.offset
        return results

    def own_values(self, values: Mapping[str, Value]) -> dict[str, Value]:
        """Start values of the FMU under our names, in our units; texts stay as they are."""
        by_name = {alias.theirs: alias for alias in self.aliases}
        results: dict[str, Value] = {}
        for name, value in values.items():
            alias = by_name.get(name, Alias(name, name))
            plain = isinstance(value, (str, bool)) or (alias.factor, alias.offset) == (1.0, 0.0)
            results[alias.ours] = value if plain else (float(value) - alias.offset) / alias.factor
        return results
