"""Units as data loggers, engineers and programs write them, in SI base units, and those of our names of variables."""

from __future__ import annotations

import math
import re
from collections import Counter

from ali3.near_names import did_you_mean
from ali3.unit_definition import UnitDefinition
from hosts.common.errors import HostError

_DEGREE, _INCH, _POUND_FORCE, _G = math.pi / 180.0, 0.0254, 4.4482216152605, 9.80665
_ANGLE, _RATE, _LENGTH = {"rad": 1}, {"rad": 1, "s": -1}, {"m": 1}
_SPEED, _ACCELERATION = {"m": 1, "s": -1}, {"m": 1, "s": -2}
_FORCE, _TORQUE = {"kg": 1, "m": 1, "s": -2}, {"kg": 1, "m": 2, "s": -2}
_PRESSURE, _POWER, _TIME = {"kg": 1, "m": -1, "s": -2}, {"kg": 1, "m": 2, "s": -3}, {"s": 1}

_UNITS: dict[str, tuple[dict[str, int], float, float]] = {
    "1": ({}, 1.0, 0.0),
    "%": ({}, 0.01, 0.0),
    "rad": (_ANGLE, 1.0, 0.0),
    "mrad": (_ANGLE, 1e-3, 0.0),
    "deg": (_ANGLE, _DEGREE, 0.0),
    "rad/s": (_RATE, 1.0, 0.0),
    "mrad/s": (_RATE, 1e-3, 0.0),
    "deg/s": (_RATE, _DEGREE, 0.0),
    "rpm": (_RATE, math.pi / 30.0, 0.0),
    "rad/s2": ({"rad": 1, "s": -2}, 1.0, 0.0),
    "deg/s2": ({"rad": 1, "s": -2}, _DEGREE, 0.0),
    "m": (_LENGTH, 1.0, 0.0),
    "cm": (_LENGTH, 1e-2, 0.0),
    "mm": (_LENGTH, 1e-3, 0.0),
    "km": (_LENGTH, 1e3, 0.0),
    "in": (_LENGTH, _INCH, 0.0),
    "ft": (_LENGTH, 12.0 * _INCH, 0.0),
    "m/s": (_SPEED, 1.0, 0.0),
    "mm/s": (_SPEED, 1e-3, 0.0),
    "km/h": (_SPEED, 1.0 / 3.6, 0.0),
    "mph": (_SPEED, 0.44704, 0.0),
    "kn": (_SPEED, 1852.0 / 3600.0, 0.0),
    "m/s2": (_ACCELERATION, 1.0, 0.0),
    "mm/s2": (_ACCELERATION, 1e-3, 0.0),
    "g": (_ACCELERATION, _G, 0.0),
    "mg": (_ACCELERATION, 1e-3 * _G, 0.0),
    "N": (_FORCE, 1.0, 0.0),
    "daN": (_FORCE, 10.0, 0.0),
    "kN": (_FORCE, 1e3, 0.0),
    "lbf": (_FORCE, _POUND_FORCE, 0.0),
    "N.m": (_TORQUE, 1.0, 0.0),
    "kN.m": (_TORQUE, 1e3, 0.0),
    "lbf.ft": (_TORQUE, 12.0 * _INCH * _POUND_FORCE, 0.0),
    "Pa": (_PRESSURE, 1.0, 0.0),
    "hPa": (_PRESSURE, 1e2, 0.0),
    "kPa": (_PRESSURE, 1e3, 0.0),
    "MPa": (_PRESSURE, 1e6, 0.0),
    "bar": (_PRESSURE, 1e5, 0.0),
    "psi": (_PRESSURE, _POUND_FORCE / _INCH**2, 0.0),
    "W": (_POWER, 1.0, 0.0),
    "kW": (_POWER, 1e3, 0.0),
    "J": (_TORQUE, 1.0, 0.0),
    "kJ": (_TORQUE, 1e3, 0.0),
    "kg": ({"kg": 1}, 1.0, 0.0),
    "s": (_TIME, 1.0, 0.0),
    "ms": (_TIME, 1e-3, 0.0),
    "Hz": ({"s": -1}, 1.0, 0.0),
    "K": ({"K": 1}, 1.0, 0.0),
    "degC": ({"K": 1}, 1.0, 273.15),
}
_OTHER_NAMES = {
    "": "1", "-": "1", "none": "1", "percent": "%", "pct": "%", "°": "deg", "degree": "deg", "degrees": "deg",
    "°/s": "deg/s", "deg/sec": "deg/s", "degree/s": "deg/s", "°/s2": "deg/s2",
    "1/min": "rpm", "U/min": "rpm", "r/min": "rpm", "min-1": "rpm",
    "meter": "m", "metre": "m", "kph": "km/h", "kmh": "km/h", "km/hr": "km/h", "knot": "kn", "knots": "kn",
    "m/s/s": "m/s2", "m/sec2": "m/s2", "ms-2": "m/s2", "G": "g", "Nm": "N.m", "N*m": "N.m", "N m": "N.m", "kNm": "kN.m",
    "g's": "g", "mbar": "hPa", "°C": "degC", "C": "degC", "sec": "s", "rad/sec": "rad/s", "kmph": "km/h",
}  # fmt: skip
_OF_OUR_NAMES = (
    (r"steering_(wheel|arm)_torque|drive_torque|motor_torque|.*\.(brake_torque|M[xyz])", "N.m"),
    (r"steering_wheel_angle.*|used\.steering_wheel_angle_demand|sideslip|steering_demand_excess", "rad"),
    (r"steering_(arm|link)_angle", "rad"),
    (r"chassis\.(yaw|pitch|roll)|initial\.yaw|wheel_..\.(steer|camber|inclination|slip_angle|angle)", "rad"),
    (r"vehicle\.(steering_wheel_angle_max|front_wheel_angle_max)|anti_roll_bar_..\.angle", "rad"),
    (r"vehicle\.steering_frequency", "Hz"),
    (r"chassis\.w[xyz]|wheel_..\.omega|engine_speed|motor_speed|steering_wheel_speed|initial\.yaw_rate", "rad/s"),
    (r"speed|initial\.(lateral_)?speed|chassis\.v[xyz]", "m/s"),
    (r"chassis\.a[xyz]|accelerometer_..\.a[xyz]", "m/s2"),
    (r"chassis\.[xyz]|initial\.[xyz]|wheel_..\.(x|y|z|travel|deflection|contact_[xyz])|steering_(rack|link_[xy])", "m"),
    (r"spring_..\.length|road\.kerb_(x|height)|vehicle\.(wheelbase|track_front|track_rear|length|width)", "m"),
    (r"wheel_..\.F[xyz]|spring_..\.force|steering_rack_force|chassis\.ground_force", "N"),
    (r"energy\..*|solver\.energy_error", "J"),
    (r"stress\.SG\d+", "Pa"),
    (r"bending_moment\.SG\d+", "N.m"),
)
"""For FMUs of others, which do not tell the units of our names."""


def unit_definition(text: str, where: str) -> UnitDefinition:
    """A unit that a person or a logger has written.

    `text`: such as ``km/h``, ``°/s`` or ``[m/s^2]``; `where`: how messages call where it stands. Raises `HostError`: it
    is not known; with near ones.
    """
    found = known_unit(text)
    if found is None:
        raise HostError(
            f"{where}: the unit '{text}' is not known{did_you_mean(_plain(text), _UNITS, closeness=0.4)} In a log "
            "another can be given by a factor: "
            "value in the log = factor * value in the FMU's unit + offset."
        )
    return found


def known_unit(text: str) -> UnitDefinition | None:
    """A unit as written, or None where it is not known."""
    name = _plain(text)
    name = _OTHER_NAMES.get(name, name)
    if name not in _UNITS:
        return _compound(name)
    exponents, factor, offset = _UNITS[name]
    return UnitDefinition(exponents, factor, offset)


def _compound(text: str) -> UnitDefinition | None:
    """Products and one quotient of known units, such as ``rad.s2/m``, ``deg/g`` or ``m/(s2.rad)``."""
    above, slash, below = text.partition("/")
    if slash and "." in below and not re.fullmatch(r"\([^()]*\)", below):
        return None  # it could be meant either way
    exponents, factor = Counter[str](), 1.0
    for part, sign in ((above, 1), (below.strip("()"), -1)):
        for word in part.split(".") if part else []:
            found = re.fullmatch(r"(.*?[^\d]|1)(\d?)", word)
            name = "" if found is None else _OTHER_NAMES.get(found[1], found[1])
            if found is None or name not in _UNITS or _UNITS[name][2]:
                return None
            power = sign * int(found[2] or 1)
            factor *= _UNITS[name][1] ** power
            exponents.update({base: power * n for base, n in _UNITS[name][0].items()})
    return UnitDefinition({base: n for base, n in exponents.items() if n}, factor)


def unit_of(name: str) -> str | None:
    """The unit of a variable of ours as FMI writes it, such as ``rad/s``; None where the name is not known."""
    return next((unit for pattern, unit in _OF_OUR_NAMES if re.fullmatch(pattern, name)), None)


def same_quantity(one: UnitDefinition, other: UnitDefinition) -> bool:
    """Whether both measure the same; angles count as numbers."""
    first, second = ({b: n for b, n in unit.exponents.items() if b != "rad"} for unit in (one, other))
    return first == second


def conversion(unit: str, other: str, where: str = "the unit") -> float:
    """The factor from values in a unit to those in another.

    `unit`, `other`: as a person writes them; `where`: how messages call where `unit` stands. Raises `HostError`: one is
    not known, the two measure different quantities, or their zeros differ.
    """
    if unit == other:
        return 1.0
    first, second = unit_definition(unit, where), unit_definition(other, where)
    if not same_quantity(first, second) or first.offset != second.offset:
        raise HostError(f"{where}: '{unit}' is no unit of what is measured in {other}.")
    pairs = ((unit, second), (other, first))
    turns = [math.tau if _is_hertz(name) and "rad" in of.exponents else 1.0 for name, of in pairs]
    return turns[0] * first.factor / (turns[1] * second.factor)


def _is_hertz(text: str) -> bool:
    """Whether a unit counts turns, where others count radians."""
    name = _plain(text)
    return _OTHER_NAMES.get(name, name) == "Hz"


def says_nothing(unit: UnitDefinition) -> bool:
    """Whether it is the plain number 1, which FMUs also give where nobody has thought of a unit."""
    return not unit.exponents and (unit.factor, unit.offset) == (1.0, 0.0)


def _plain(text: str) -> str:
    word = text.strip()
    while word[:1] + word[-1:] in ("[]", "()") and len(word) > 1:
        word = word[1:-1].strip()
    for written, plain in (("²", "2"), ("^", ""), ("**", ""), ("·", "."), ("º", "°")):
        word = word.replace(written, plain)
    return word
