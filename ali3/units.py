"""Units as data loggers, engineers and programs write them, their definitions in SI base units, and usual confusions.

Files have units as in `UNITS`, such as ``m/s2`` and ``N.m``; `typeset` converts them for readers.
"""

import argparse
import math
import re
from collections import Counter
from collections.abc import Callable
from typing import NamedTuple

from ali3.decimal_number import DECIMAL, number, parse_number, short
from ali3.unit_definition import UnitDefinition

_DEGREE = math.pi / 180.0
_INCH = 0.0254
_POUND_FORCE = 4.4482216152605
_G = 9.80665
_ANGLE = {"rad": 1}
_RATE = {"rad": 1, "s": -1}
_LENGTH = {"m": 1}
_SPEED = {"m": 1, "s": -1}
_ACCELERATION = {"m": 1, "s": -2}
_FORCE = {"kg": 1, "m": 1, "s": -2}
_TORQUE = {"kg": 1, "m": 2, "s": -2}
_PRESSURE = {"kg": 1, "m": -1, "s": -2}
_POWER = {"kg": 1, "m": 2, "s": -3}
_TIME = {"s": 1}

UNITS: dict[str, tuple[dict[str, int], float, float]] = {
    "1": ({}, 1.0, 0.0),
    "%": ({}, 0.01, 0.0),
    "rad": (_ANGLE, 1.0, 0.0),
    "mrad": (_ANGLE, 1e-3, 0.0),
    "deg": (_ANGLE, _DEGREE, 0.0),
    "rad/s": (_RATE, 1.0, 0.0),
    "mrad/s": (_RATE, 1e-3, 0.0),
    "deg/s": (_RATE, _DEGREE, 0.0),
    "rpm": (_RATE, math.pi / 30.0, 0.0),
    "r/s": (_RATE, math.tau, 0.0),
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
OTHER_NAMES = {
    "": "1", "-": "1", "none": "1", "percent": "%", "pct": "%", "°": "deg", "degree": "deg", "degrees": "deg",
    "°/s": "deg/s", "deg/sec": "deg/s", "degree/s": "deg/s", "°/s2": "deg/s2",
    "1/min": "rpm", "U/min": "rpm", "r/min": "rpm", "min-1": "rpm",
    "meter": "m", "metre": "m", "kph": "km/h", "kmh": "km/h", "km/hr": "km/h", "knot": "kn", "knots": "kn",
    "m/s/s": "m/s2", "m/sec2": "m/s2", "ms-2": "m/s2", "G": "g", "Nm": "N.m", "kNm": "kN.m",
    "g's": "g", "mbar": "hPa", "°C": "degC", "C": "degC", "sec": "s", "rad/sec": "rad/s", "kmph": "km/h",
}  # fmt: skip
_CONFUSED = (
    ("m/s", "km/h", "mph", "kn", "ft/s", "mm/s"),
    ("rad/s", "deg/s", "rpm", "r/s"),
    ("m/s2", "g", "mm/s2", "mg", "ft/s2"),
    ("rad", "deg"),
    ("rad/s2", "deg/s2"),
    ("m", "mm", "cm", "km", "ft"),
    ("N", "kN"),
    ("N.m", "kN.m"),
    ("Pa", "bar", "kPa", "MPa"),
    ("W", "kW"),
    ("J", "kJ"),
    ("1", "%", "deg"),
)
"""Units that are confused with each other: the SI unit, the most usual other one, others."""
_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_EXPONENT = re.compile(r"(?<=[a-zA-Z])(-?\d+)(\.\d+)?")


class Misread(NamedTuple):
    """Values in one unit that were read as values in another one; `factor` corrects them."""

    factor: float
    unit: str
    taken: str
    usual: bool
    """Whether the two units are the most usual confusion of the quantity."""

    @property
    def words(self) -> str:
        """Description, such as "km/h instead of m/s"."""
        return f"{typeset(self.unit) or '1'} instead of {typeset(self.taken) or '1'}"


def misread(unit: str) -> list[Misread]:
    """Possible confusions of values in a unit, the usual ones first; of all units if `unit` is empty."""
    results = []
    for group in _CONFUSED:
        unit_name = _standard_name(unit) if unit else group[0]
        if unit_name not in group:
            continue
        si_unit = group[unit_name == group[0]]
        pairs = [
            (si_unit, unit_name),
            (unit_name, si_unit),
            *((other_unit, unit_name) for other_unit in group if other_unit not in (unit_name, si_unit)),
        ]
        results += [Misread(_scale(a) / _scale(b), a, b, si_unit in (a, b)) for a, b in pairs]
        if unit:
            break  # deg is primarily the unit of an angle
    return sorted(results, key=lambda one: not one.usual)


def _standard_name(unit: str) -> str:
    name = plain_unit(unit)
    return OTHER_NAMES.get(name, name)


def _scale(unit: str) -> float:
    definition = known_unit(unit)
    assert definition is not None
    return definition.factor


def typeset(unit: str) -> str:
    """A unit for readers, such as m/s² for ``m/s2``; empty for ratios."""
    if unit in ("1", ""):
        return ""
    text = re.sub(r"\.(?=[a-zA-Z])", "·", unit)
    return _EXPONENT.sub(lambda match: f"^{match[0]}" if match[2] else match[0].translate(_SUPERSCRIPTS), text)


def known_unit(text: str) -> UnitDefinition | None:
    """Definition of a unit in any notation; None if it is not known."""
    name = _standard_name(text)
    if name not in UNITS:
        return _compound(name)
    exponents, factor, offset = UNITS[name]
    return UnitDefinition(exponents, factor, offset)


def _compound(text: str) -> UnitDefinition | None:
    """Definition of products and one quotient of known units, such as ``rad.s2/m``, ``deg/g`` or ``m/(s2.rad)``."""
    numerator, slash, denominator = text.partition("/")
    if slash and "." in denominator and not re.fullmatch(r"\([^()]*\)", denominator):
        return None  # ambiguous
    exponents, factor = Counter[str](), 1.0
    for part, sign in ((numerator, 1), (denominator.strip("()"), -1)):
        for word in part.split(".") if part else []:
            match = re.fullmatch(r"(.*?[^\d]|1)(\d?)", word)
            name = "" if match is None else OTHER_NAMES.get(match[1], match[1])
            if match is None or name not in UNITS or UNITS[name][2]:
                return None
            power = sign * int(match[2] or 1)
            factor *= UNITS[name][1] ** power
            exponents.update({base: power * n for base, n in UNITS[name][0].items()})
    return UnitDefinition({base: n for base, n in exponents.items() if n}, factor)


def same_quantity(one: UnitDefinition, other: UnitDefinition) -> bool:
    """Whether two units are of the same quantity; angles count as ratios."""
    first, second = ({b: n for b, n in unit.exponents.items() if b != "rad"} for unit in (one, other))
    return first == second


def plain_unit(text: str) -> str:
    """A unit without brackets, with uniform notation of powers and products."""
    word = text.strip()
    while word[:1] + word[-1:] in ("[]", "()") and len(word) > 1:
        word = word[1:-1].strip()
    for notation, replacement in (("²", "2"), ("^", ""), ("**", ""), ("·", "."), ("*", "."), ("º", "°")):
        word = word.replace(notation, replacement)
    return re.sub(r"\s+", ".", re.sub(r"\s*([./])\s*", r"\1", word))


def number_with_unit(text: str, unit: str) -> float:
    """A number of the command line, converted to a unit.

    `text`: a number in that unit, or one followed by another unit of the same quantity, such as ``20kN/m`` if the unit
    is N/m; `unit`: empty if it is not known. Raises `ValueError` with the text and what would be right, to stand after
    a colon in a message.
    """
    word = text.strip()
    match = re.fullmatch(rf"(?P<number>[+-]?{DECIMAL})\s*(?P<unit>[A-Za-z%°].*)", word, re.ASCII)
    try:
        return parse_number(word)
    except ValueError:
        if match is None:
            raise
    target_unit, given_unit = known_unit(unit), known_unit(match["unit"])
    if not unit or target_unit is None:
        raise ValueError(f"{short(word)} is not a number; write it without a unit, such as {match['number']}")
    if given_unit is None or given_unit.exponents != target_unit.exponents:
        form_text = (
            f"in {unit}, or with a unit of the same quantity behind it" if target_unit.exponents else "without a unit"
        )
        raise ValueError(
            f"{short(word)} is not a number; write one {form_text}, such as {match['number']}{_example(unit)}"
        )
    return given_unit.convert(parse_number(match["number"]), target_unit)


def _example(unit: str) -> str:
    return "" if unit == "1" else unit


def quantity(unit: str) -> Callable[[str], float]:
    """The type of an option whose value is in a unit, for ``add_argument``; see `number_with_unit`."""

    def parsed(text: str) -> float:
        try:
            return number(text)
        except argparse.ArgumentTypeError:
            try:
                return number_with_unit(text, unit)
            except ValueError as error:
                raise argparse.ArgumentTypeError(str(error)) from None

    return parsed
