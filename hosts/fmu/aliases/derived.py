"""A variable of ours that the FMU does not have, computed from those that it has."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

from ali3.near_names import did_you_mean
from hosts.common.errors import HostError
from hosts.fmu.aliases.formulas import FORMULAS, Formula

_CALL = re.compile(r"\s*(\w+)\s*\(([^()]*)\)\s*")


@dataclass(frozen=True)
class Derived:
    """One variable.

    Parameters
    ----------
    ours : str
        Name.
    formula : str
        Of `FORMULAS`.
    arguments : tuple of str or float
        Names of ours, else of the FMU; or numbers.
    """

    ours: str
    formula: str
    arguments: tuple[str | float, ...]

    @property
    def how(self) -> Formula:
        """The formula itself."""
        return FORMULAS[self.formula]

    @property
    def names(self) -> tuple[str, ...]:
        """Those arguments that are names."""
        return tuple(a for a in self.arguments if isinstance(a, str))


def parse_derived(ours: str, text: str, constants: Mapping[str, float], where: str) -> Derived:
    """A formula as an alias file has it.

    Parameters
    ----------
    constants : mapping of str to float
        Their names in `text` become numbers.
    where : str
        How messages call it.

    Raises
    ------
    HostError
        There is no such formula, or it takes other arguments.
    """
    call = _CALL.fullmatch(text)
    if call is None:
        raise HostError(f"{where}: from is '{text}'; it must be a formula such as sideslip(chassis.vx, chassis.vy).")
    name, inside = call.groups()
    if name not in FORMULAS:
        hint = did_you_mean(name, FORMULAS, f"there are {', '.join(sorted(FORMULAS))}")
        raise HostError(f"{where}: there is no formula '{name}'{hint}")
    arguments = tuple(_argument(word.strip(), constants, where) for word in inside.split(","))
    formula = FORMULAS[name]
    if not formula.takes(len(arguments)):
        raise HostError(
            f"{where}: {name} takes ({', '.join(formula.arguments)}), {len(formula.arguments)} in number; "
            f"it is given {len(arguments)}."
        )
    return Derived(ours, name, arguments)


def _argument(word: str, constants: Mapping[str, float], where: str) -> str | float:
    if word in constants:
        return constants[word]
    try:
        return float(word)
    except ValueError:
        if not word:
            raise HostError(f"{where}: an argument of the formula is empty.") from None
        return word


def in_order(derived: Sequence[Derived], known: Collection[str]) -> tuple[list[Derived], dict[str, str]]:
    """Those that can be computed, each after what it needs.

    Parameters
    ----------
    known : collection of str
        Names that are there.

    Returns
    -------
    done : list of Derived
    missing : dict of str to str
        Of the others, a name that it lacks.
    """
    there, open_ones, done = set(known), list(derived), list[Derived]()
    while True:
        ready = [d for d in open_ones if there.issuperset(d.names)]
        if not ready:
            return done, {d.ours: next(n for n in d.names if n not in there) for d in open_ones}
        done += ready
        there.update(d.ours for d in ready)
        open_ones = [d for d in open_ones if d not in ready]
