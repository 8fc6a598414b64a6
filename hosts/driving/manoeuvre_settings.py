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


def apply_settings(
    fmu: Fmu,
    manoeuvre: Manoeuvre,
    fmu_options: FmuOptions,
    fidelity: float | None = None,
    to_fmu: Callable[[Mapping[str, Any]], Mapping[str, Any]] = dict,
) -> tuple[Manoeuvre, Settings]:
    """The manoeuvre with the settings of the user, and these settings.

    Parameters
    ----------
    fmu : Fmu
        Not yet initialised.
    manoeuvre : Manoeuvre
        Where the user sets a value, it replaces the start value of the manoeuvre.
    fidelity : float, optional
        Of the option ``--fidelity``.
    to_fmu : callable
        Converts values of the manoeuvre to the names and units of the FMU; the returned start values have these.

    Raises
    ------
    HostError
        A name, value, type or unit is wrong.
    """
    settings = Settings(fmu.table)
    settings.add_numbers(to_fmu(manoeuvre.start), f"{START_OF}{manoeuvre.name}")
    settings.add_options(fmu_options, fidelity)
    settings.discard_overwritten(to_fmu(manoeuvre.inputs), f"it is a column of the manoeuvre {manoeuvre.name}")
    if manoeuvre.find_throttle:
        reason = f"the manoeuvre {manoeuvre.name} finds the throttle that holds the speed"
        settings.discard_overwritten(to_fmu({THROTTLE: 0.0}), reason)
    if manoeuvre.driver:
        acts = to_fmu(dict.fromkeys(ACTS, 0.0))
        settings.discard_overwritten(acts, f"the driver of the manoeuvre {manoeuvre.name} acts on it")
    return replace(manoeuvre, start=settings.start), settings
