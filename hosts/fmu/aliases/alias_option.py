"""The option ``--aliases`` of commands: reads the alias file, if one is given."""

from pathlib import Path

from hosts.fmu.aliases.alias import Aliases
from hosts.fmu.aliases.file import find_aliases
from hosts.fmu.variables import Variables


def aliases_of(file: str | Path | None, variables: Variables) -> Aliases:
    """The aliases of a file, or none without a file. `file`: see `hosts.fmu.aliases.file.find_aliases`.

    Raises `HostError` if the file has a fault, or does not fit this FMU.
    """
    if file is None:
        return Aliases()
    return find_aliases(file, variables)
