"""A variable of ours that the FMU does not have, computed from those that it has."""

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

    ours: str
    formula: str
    """Of `FORMULAS`."""
    arguments: tuple[str | float, ...]
    """Names of ours, else of the FMU; or numbers."""

    @property
    def how(self) -> Formula:
        """The formula itself."""
        return FORMULAS[self.formula]

    @property
    def names(self) -> tuple[str, ...]:
        """Arguments that are names."""
        return tuple(a for a in self.arguments if isinstance(a, str))


def in_order(derived: Sequence[Derived], known: Collection[str]) -> tuple[list[Derived], dict[str, str]]:
    """Those that can be computed, each after what it needs.

    Returns
    -------
    ordered : list of Derived
    missing : dict of str to str
        Of the others, a name that it lacks.
    """
    present, open_ones, ordered = set(known), list(derived), list[Derived]()
    while True:
        ready = [d for d in open_ones if present.issuperset(d.names)]
        if not ready:
            return ordered, {d.ours: next(n for n in d.names if n not in present) for d in open_ones}
        ordered += ready
        present.update(d.ours for d in ready)
        open_ones = [d for d in open_ones if d not in ready]
