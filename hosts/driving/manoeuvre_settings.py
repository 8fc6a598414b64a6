"""What a user sets in an FMU that drives a manoeuvre."""

from __future__ import annotations

from dataclasses import replace

from hosts.common.options import Wishes
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.pilots.pilot import ACTS
from hosts.fmu.aliases.alias import Aliases
from hosts.fmu.fmu import Fmu
from hosts.fmu.settings import START_OF, Settings


def set_in(
    fmu: Fmu, manoeuvre: Manoeuvre, wishes: Wishes, fidelity: float | None = None, aliases: Aliases | None = None
) -> tuple[Manoeuvre, Settings]:
    """The manoeuvre with all that the user sets, and what to say of it.

    Parameters
    ----------
    fmu : Fmu
        Not yet initialised.
    manoeuvre : Manoeuvre
        Its start values come first.
    wishes : Wishes
        Of the command line, in the names and units of the FMU.
    fidelity : float, optional
        Of the option ``--fidelity``.
    aliases : Aliases, optional
        By which the manoeuvre drives the FMU: its names and those of the start values that are returned are ours.

    Raises
    ------
    HostError
        A name, value, kind or unit is wrong.
    """
    aliases = Aliases() if aliases is None else aliases
    settings = Settings(fmu.table)
    settings.add_numbers(aliases.values(manoeuvre.start), f"{START_OF}{manoeuvre.name}")
    settings.add_wishes(wishes, fidelity)
    settings.overwritten(aliases.values(manoeuvre.inputs), f"it is a column of the manoeuvre {manoeuvre.name}")
    if manoeuvre.driver:
        acts = aliases.values(dict.fromkeys(ACTS, 0.0))
        settings.overwritten(acts, f"the driver of the manoeuvre {manoeuvre.name} acts on it")
    return replace(manoeuvre, start=aliases.own_values(settings.start)), settings
