"""Derived variables: variables that the FMU lacks, computed from those that it has."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from hosts.fmu.aliases.formulas import FORMULAS

if TYPE_CHECKING:
    from hosts.fmu.aliases.formulas import Formula


@dataclass(frozen=True)
class Derived:
    """A derived variable: its name and formula."""

    name: str
    """ALi3 name."""
    formula: str
    """Name in `FORMULAS`."""
    arguments: tuple[str | float, ...]
    """ALi3 names of variables, names in the FMU of those without one, or numbers."""

    @property
    def function(self) -> Formula:
        """The formula."""
        return FORMULAS[self.formula]

    @property
    def names(self) -> tuple[str, ...]:
        """Arguments that are names."""
        return tuple(a for a in self.arguments if isinstance(a, str))


def sort_derived(derived: Sequence[Derived], known: Collection[str]) -> tuple[list[Derived], dict[str, str]]:
    """The derived variables that can be computed, each after those that it needs.

    Returns
    -------
    ordered : list of Derived
    missing : dict of str to str
        By name of each other variable, an argument that it lacks.
    """
    available, remaining, ordered = set(known), list(derived), list[Derived]()
    while True:
        ready = [d for d in remaining if available.issuperset(d.names)]
        if not ready:
            return ordered, {d.name: next(n for n in d.names if n not in available) for d in remaining}
        ordered += ready
        available.update(d.name for d in ready)
        remaining = [d for d in remaining if d not in ready]
