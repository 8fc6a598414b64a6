"""Units as other programs call them."""

from __future__ import annotations

from ali3.parameter_set import UnitDefinition
from hosts.common.unit_names import unit_definition

_NAMES = (
    *("1", "-", "", "%", "s", "ms", "m", "mm", "cm", "km", "m/s", "km/h", "kph", "kmh", "mph"),
    *("m/s2", "m/s^2", "m/s²", "g", "g's", "rad", "deg", "°", "degree", "rad/s", "deg/s", "°/s", "rpm", "1/min"),
    *("N", "kN", "N.m", "Nm", "N m", "N*m", "Pa", "kPa", "bar", "MPa"),
)

KNOWN = {name: unit_definition(name.removesuffix("'s"), "units") for name in _NAMES}
"""Units by the names that programs use; where an FMU defines a unit itself, its definition counts."""


def same_quantity(one: UnitDefinition, other: UnitDefinition) -> bool:
    """Whether both measure the same; angles count as numbers."""
    first, second = ({b: n for b, n in unit.exponents.items() if b != "rad"} for unit in (one, other))
    return first == second


def says_nothing(unit: UnitDefinition) -> bool:
    """Whether it is the plain number 1, which FMUs also give where nobody has thought of a unit."""
    return not unit.exponents and (unit.factor, unit.offset) == (1.0, 0.0)
