"""Derived variables: variables that the FMU lacks, computed from those that it has."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ali3.near_names import did_you_mean
from hosts.common.errors import HostError
from hosts.fmu.aliases.formulas import FORMULAS

if TYPE_CHECKING:
    from hosts.fmu.aliases.formulas import Formula

_CALL = re.compile(r"\s*(\w+)\s*\(([^()]*)\)\s*")


def parse_derived(name: str, text: str, constants: Mapping[str, float], where: str) -> Derived:
    """The derived variable of an entry of an alias file.

    `name`: ALi3 name; `text`: formula, in which `constants` replace their names; `where`: subject of messages. Raises
    `HostError` if the formula does not exist, or takes other arguments.
    """
    match = _CALL.fullmatch(text)
    if match is None:
        raise HostError(f"{where}: from is '{text}'; it must be a formula such as sideslip(chassis.vx, chassis.vy).")
    formula_name, argument_text = match.groups()
    if formula_name not in FORMULAS:
        hint = did_you_mean(formula_name, FORMULAS, f"there are {', '.join(sorted(FORMULAS))}")
        raise HostError(f"{where}: there is no formula '{formula_name}'{hint}")
    arguments = tuple(_argument(word.strip(), constants, where) for word in argument_text.split(","))
    formula = FORMULAS[formula_name]
    if not formula.accepts(len(arguments)):
        raise HostError(
            f"{where}: {formula_name} takes ({', '.join(formula.arguments)}), {len(formula.arguments)} in number; "
            f"it is given {len(arguments)}."
        )
    return Derived(name, formula_name, arguments)


def _argument(word: str, constants: Mapping[str, float], where: str) -> str | float:
    if word in constants:
        return constants[word]
    try:
        return float(word)
    except ValueError:
        if not word:
            raise HostError(f"{where}: an argument of the formula is empty.") from None
        return word


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
