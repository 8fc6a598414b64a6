"""Our names for the variables of an FMU of another program: names, units, signs, frames."""

from hosts.fmu.aliases.alias import Alias, Aliases
from hosts.fmu.aliases.content import CONSTANTS, shipped_names
from hosts.fmu.aliases.derivation import Derivation
from hosts.fmu.aliases.derived import Derived
from hosts.fmu.aliases.file import find_aliases, read_aliases

__all__ = [
    "CONSTANTS",
    "Alias",
    "Aliases",
    "Derivation",
    "Derived",
    "find_aliases",
    "read_aliases",
    "shipped_names",
]
