"""The option ``--aliases`` of commands: reads the alias file, if one is given."""

from pathlib import Path

from hosts.fmu.aliases.alias import Aliases
from hosts.fmu.aliases.file import find_aliases
from hosts.fmu.variables import Variables


def aliases_of(file: str | Path | None, variables: Variables) -> Aliases:
    """Those of a file, none where none is named. `file`: as `hosts.fmu.aliases.file.find_aliases` takes it.

    Raises `HostError`: the file is not right, or is none for this FMU.
    """
    if file is None:
        return Aliases()
    return find_aliases(file, variables)
