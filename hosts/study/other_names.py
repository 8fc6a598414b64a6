"""A study of an FMU with an alias file: what it runs has our names."""

from __future__ import annotations

from pathlib import Path

from ali3.reading import is_file
from hosts.common.errors import HostError
from hosts.driving.simulated_fmu import SimulatedFmu
from hosts.fmu.aliased_fmu import AliasedFmu
from hosts.fmu.aliases.alias import Aliases
from hosts.fmu.aliases.of_file import aliases_of
from hosts.fmu.fmu import Fmu
from hosts.fmu.variables import Variable


def aliases_beside(name: str, file: Path, fmu: Fmu) -> Aliases:
    """The aliases that a study file names: a file beside it, else one of the package.

    Raises `HostError`: the file is not right, or is none for this FMU.
    """
    beside = file.parent / name
    return aliases_of(beside if is_file(beside) else name, fmu.table)


def renamed_variable(fmu: SimulatedFmu, name: str, where: str) -> Variable | None:
    """A variable that can be set, by our name and in our unit; None where it has no name of ours.

    Raises `HostError`: it is no parameter or input.
    """
    if not isinstance(fmu, AliasedFmu) or name not in fmu.table:
        return None
    found = fmu.table[name]
    if found.may_be_set:
        return found
    raise HostError(f"{where}: '{name}' is no parameter or input of the FMU; it cannot be set.")
