"""The units in which reports show what is computed in those of the SI: degrees, deg/g, km/h; tables of data keep SI."""

import math
from typing import NamedTuple

from ali3.units import known_unit, typeset
from hosts.common.units import conversion

_SHOWN = {
    "rad": "deg",
    "rad/s": "deg/s",
    "rad/s2": "deg/s2",
    "rad.s": "deg.s",
    "rad.s2/m": "deg/g",
    "m/(s2.rad)": "m/(s2.deg)",
    "N.s2": "N.m/g",
    "m/s": "km/h",
    "Pa": "MPa",
}


class Shown(NamedTuple):
    """A display unit: values in the unit itself times `factor` are in `unit`."""

    unit: str
    factor: float


def shown_in(unit: str, name: str = "") -> Shown:
    """The unit in which a quantity is shown.

    `unit`: as units of FMI are written; `name`: of the quantity: angular frequencies are shown in Hz, the spin of
    wheels (``omega``) in rpm, as the FMU declares it, other angular velocities in deg/s.
    """
    if unit == "rad/s" and name.endswith("frequency"):
        return Shown("Hz", 1.0 / math.tau)
    display_unit = "rpm" if unit == "rad/s" and "omega" in name else _SHOWN.get(unit, unit)
    return Shown(display_unit, 1.0 if display_unit == unit else conversion(unit, display_unit))


def axis_shown(label: str) -> Shown:
    """The label of an axis that ends with its unit, such as ``yaw rate, rad/s``, and the factor of its values."""
    quantity, comma, unit = label.rpartition(", ")
    shown = shown_in(unit)
    known = comma and known_unit(shown.unit)
    return Shown(titled(quantity, shown.unit) if known else f"{quantity}{comma}{shown.unit}", shown.factor)


def titled(name: str, unit: str) -> str:
    """A name with its unit, as of an axis."""
    return ", ".join(filter(None, (name, typeset(unit))))


def number_in(value: float, unit: str, form: str = ".4g") -> str:
    """A number with its typeset unit, for a text."""
    return f"{value:{form}} {typeset(unit)}".rstrip()


def shown_number(value: float, unit: str, name: str) -> str:
    """A number in the unit in which the quantity of a name is shown."""
    shown = shown_in(unit, name)
    return number_in(shown.factor * value, shown.unit)
