"""Parameters and start values that a user sets for a manoeuvre."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from hosts.common.options import FmuOptions
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.pilots.pilot import ACTS
from hosts.driving.steady_throttle import THROTTLE
from hosts.fmu.fmu import Fmu
from hosts.fmu.settings import START_OF, Settings


def set_in(
    fmu: Fmu,
    manoeuvre: Manoeuvre,
    fmu_options: FmuOptions,
    fidelity: float | None = None,
    theirs: Callable[[Mapping[str, Any]], Mapping[str, Any]] = dict,
) -> tuple[Manoeuvre, Settings]:
    """The manoeuvre with all that the user sets, and what to say of it.

    Parameters
    ----------
    fmu : Fmu
        Not yet initialised.
    manoeuvre : Manoeuvre
        Its start values come first.
    fidelity : float, optional
        Of the option ``--fidelity``.
    theirs : callable
        Gives values of the manoeuvre by the names and in the units of the FMU, in which the start values are returned.

    Raises
    ------
    HostError
        A name, value, kind or unit is wrong.
    """
    settings = Settings(fmu.table)
    settings.add_numbers(theirs(manoeuvre.start), f"{START_OF}{manoeuvre.name}")
    settings.add_options(fmu_options, fidelity)
    settings.discard_overwritten(theirs(manoeuvre.inputs), f"it is a column of the manoeuvre {manoeuvre.name}")
    if manoeuvre.find_throttle:
        result = f"the manoeuvre {manoeuvre.name} takes the one that holds the speed"
        settings.discard_overwritten(theirs({THROTTLE: 0.0}), result)
    if manoeuvre.driver:
        acts = theirs(dict.fromkeys(ACTS, 0.0))
        settings.discard_overwritten(acts, f"the driver of the manoeuvre {manoeuvre.name} acts on it")
    return replace(manoeuvre, start=settings.start), settings
