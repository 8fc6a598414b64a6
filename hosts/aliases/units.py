"""Units as other programs call them."""

from __future__ import annotations

import math

from ali3.parameter_set import UnitDefinition

_DEGREE, _TURN, _GRAVITY = math.pi / 180.0, 2.0 * math.pi, 9.80665
_LENGTH, _SPEED = {"m": 1}, {"m": 1, "s": -1}
_ACCELERATION, _FORCE = {"m": 1, "s": -2}, {"kg": 1, "m": 1, "s": -2}
_TORQUE, _PRESSURE = {"kg": 1, "m": 2, "s": -2}, {"kg": 1, "m": -1, "s": -2}
_ANGLE, _ROTATION = {"rad": 1}, {"rad": 1, "s": -1}

KNOWN = {
    name: UnitDefinition(exponents, factor)
    for exponents, names in (
        ({}, {"1": 1.0, "-": 1.0, "": 1.0, "%": 0.01}),
        ({"s": 1}, {"s": 1.0, "ms": 1e-3}),
        (_LENGTH, {"m": 1.0, "mm": 1e-3, "cm": 0.01, "km": 1e3}),
        (_SPEED, {"m/s": 1.0, "km/h": 1.0 / 3.6, "kph": 1.0 / 3.6, "kmh": 1.0 / 3.6, "mph": 0.44704}),
        (_ACCELERATION, {"m/s2": 1.0, "m/s^2": 1.0, "m/s²": 1.0, "g": _GRAVITY, "g's": _GRAVITY}),
        (_ANGLE, {"rad": 1.0, "deg": _DEGREE, "°": _DEGREE, "degree": _DEGREE}),
        (_ROTATION, {"rad/s": 1.0, "deg/s": _DEGREE, "°/s": _DEGREE, "rpm": _TURN / 60.0, "1/min": _TURN / 60.0}),
        (_FORCE, {"N": 1.0, "kN": 1e3}),
        (_TORQUE, {"N.m": 1.0, "Nm": 1.0, "N m": 1.0, "N*m": 1.0}),
        (_PRESSURE, {"Pa": 1.0, "kPa": 1e3, "bar": 1e5, "MPa": 1e6}),
    )
    for name, factor in names.items()
}
"""Units by the names that programs use; where an FMU defines a unit itself, its definition counts."""


def same_quantity(one: UnitDefinition, other: UnitDefinition) -> bool:
    """Whether both measure the same; angles count as numbers."""
    first, second = ({b: n for b, n in unit.exponents.items() if b != "rad"} for unit in (one, other))
    return first == second


def says_nothing(unit: UnitDefinition) -> bool:
    """Whether it is the plain number 1, which FMUs also give where nobody has thought of a unit."""
    return not unit.exponents and (unit.factor, unit.offset) == (1.0, 0.0)
