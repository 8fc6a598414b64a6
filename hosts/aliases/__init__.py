"""Our names for the variables of an FMU of another program: names, units, signs, frames."""

from hosts.aliases.alias import Alias, Aliases
from hosts.aliases.content import CONSTANTS, shipped_names
from hosts.aliases.derivation import Derivation
from hosts.aliases.derived import Derived
from hosts.aliases.file import find_aliases, read_aliases

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
