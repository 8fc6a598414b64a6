"""Reads the entry of an alias file that derives a variable."""

import re
from collections.abc import Mapping

from ali3.near_names import did_you_mean
from hosts.common.errors import HostError
from hosts.fmu.aliases.derived_variable import Derived
from hosts.fmu.aliases.formulas import FORMULAS

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
