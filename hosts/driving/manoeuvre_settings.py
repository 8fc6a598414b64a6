"""What a user sets in an FMU that drives a manoeuvre."""

from __future__ import annotations

from dataclasses import replace

from hosts.common.errors import HostError
from hosts.common.options import Wishes
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.pilots.pilot import ACTS
from hosts.fmu.fmu import Fmu
from hosts.fmu.settings import START_OF, Settings, settings_of


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
    settings = settings_of(fmu.table, wishes, manoeuvre.start, f"{START_OF}{manoeuvre.name}")
    if fidelity is not None:
        if "fidelity" in dict(wishes.values):
            raise HostError("The fidelity is given by --fidelity and by --set; give it once.")
        settings.add_numbers({"fidelity": fidelity}, "--fidelity")
    settings.overwritten(manoeuvre.inputs, f"it is a column of the manoeuvre {manoeuvre.name}")
    if manoeuvre.driver:
        settings.overwritten(ACTS, f"the driver of the manoeuvre {manoeuvre.name} acts on it")
    return replace(manoeuvre, start=settings.start), settings
