"""What a user sets in an FMU that drives a manoeuvre."""

from __future__ import annotations

from dataclasses import replace

from hosts.common.options import Wishes
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.pilots.pilot import ACTS
from hosts.fmu.fmu import Fmu
from hosts.fmu.settings import START_OF, Settings


def set_in(fmu: Fmu, manoeuvre: Manoeuvre, wishes: Wishes, fidelity: float | None = None) -> tuple[Manoeuvre, Settings]:
    """The manoeuvre with all that the user sets, and what to say of it.

    Parameters
    ----------
    fmu : Fmu
        Not yet initialised.
    manoeuvre : Manoeuvre
        Its start values come first.
    wishes : Wishes
        Of the command line.
    fidelity : float, optional
        Of the option ``--fidelity``.

    Raises
    ------
    HostError
        A name, value, kind or unit is wrong.
    """
    settings = Settings(fmu.table)
    settings.add_numbers(manoeuvre.start, f"{START_OF}{manoeuvre.name}")
    settings.add_wishes(wishes, fidelity)
    settings.overwritten(manoeuvre.inputs, f"it is a column of the manoeuvre {manoeuvre.name}")
    if manoeuvre.driver:
        settings.overwritten(ACTS, f"the driver of the manoeuvre {manoeuvre.name} acts on it")
    return replace(manoeuvre, start=settings.start), settings
