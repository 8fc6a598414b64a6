"""Unit names to SI base exponents and display units, as modelDescription.xml needs them."""

import math
import re

from ali3.unit_definition import BASE_UNITS, UnitDefinition
from ali3.units import UNITS

_SYMBOLS: dict[str, tuple[dict[str, int], float]] = {
    **{name: ({name: 1}, 1.0) for name in BASE_UNITS},
    **{name: UNITS[name][:2] for name in ("N", "J", "W", "Pa", "Hz")},
    "V": ({"kg": 1, "m": 2, "s": -3, "A": -1}, 1.0),
    "Nm": UNITS["N.m"][:2],
    "Ns": ({"kg": 1, "m": 1, "s": -1}, 1.0),
    **{name: UNITS[name][:2] for name in ("deg", "mm", "km", "rpm", "MPa", "%", "1")},
}
"""Exponents of the base units and factor to them, by symbol."""
# in a model `g` may be meant as grams and `h` as a height
_FOREIGN: dict[str, tuple[dict[str, int], float]] = {"h": ({"s": 1}, 3600.0), "g": UNITS["g"][:2]}
"""The same for symbols that only other programs use."""

_TOKEN = re.compile(r"([A-Za-z]+|1|%)\^?([+-]?\d+)?")

DISPLAY_UNITS: dict[str, dict[str, float]] = {
    "rad": {"deg": 180.0 / math.pi},
    "rad/s": {"deg/s": 180.0 / math.pi, "rpm": 30.0 / math.pi},
    "rad/s2": {"deg/s2": 180.0 / math.pi},
    "m/s": {"km/h": 3.6},
    "Pa": {"MPa": 1e-6},
}
"""Display units by unit, the usual one first, with their factors: value in the display unit = factor * value."""

QUANTITIES: dict[str, str] = {
    "1": "Ratio",
    "m": "Length",
    "s": "Time",
    "rad": "Angle",
    "m/s": "Velocity",
    "rad/s": "AngularVelocity",
    "m/s2": "Acceleration",
    "rad/s2": "AngularAcceleration",
    "N": "Force",
    "N.m": "Torque",
    "N.m/rad": "RotationalStiffness",
    "N/m": "Stiffness",
    "J": "Energy",
    "W": "Power",
    "Pa": "Stress",
    "kg": "Mass",
    "Hz": "Frequency",
    "N.s/m": "Damping",
    "N.m.s/rad": "RotationalDamping",
    "N.s": "Impulse",
    "N.m.s": "AngularMomentum",
    "kg/m": "LinearDensity",
    "kg/m3": "Density",
    "kg.m2": "MomentOfInertia",
    "m2": "Area",
    "1/m": "Curvature",
    "A": "ElectricCurrent",
    "V": "ElectricPotential",
}
"""Name of the quantity in modelDescription.xml, by unit in the spelling of `canonical_unit`."""


def canonical_unit(name: str) -> str:
    """One spelling of products and powers.

    >>> canonical_unit("N m"), canonical_unit("N*m"), canonical_unit("kg m^2")
    ('N.m', 'N.m', 'kg.m2')
    """
    return re.sub(r"[*· ]+", ".", name).replace("^", "").replace("Nm", "N.m")


def parse_unit(name: str, foreign: bool = False) -> UnitDefinition:
    """Read a unit such as ``m/s2``, ``N.m/rad``, ``kg m2``.

    `name`: products by ``.``, ``*`` or a space; everything after a ``/`` divides; powers as digits with or without
    ``^``; `foreign`: whether ``h`` is an hour and ``g`` standard gravity, as other programs have them; in models they
    are not known. Exponents are in the order of the FMI standard. Raises `ValueError` if a symbol is not known.

    Examples
    --------
    >>> parse_unit("N.m/rad")
    UnitDefinition(exponents={'kg': 1, 'm': 2, 's': -2, 'rad': -1}, factor=1.0, offset=0.0)
    >>> parse_unit("mm/s").factor
    0.001
    """
    symbols = _SYMBOLS | (_FOREIGN if foreign else {})
    exponents = dict.fromkeys(BASE_UNITS, 0)
    factor = 1.0
    for k, group in enumerate(name.split("/")):
        sign = 1 if k == 0 else -1
        for token in re.split(r"[.*· ]+", group.strip().strip("()")):
            match = _TOKEN.fullmatch(token)
            if match is None or match[1] not in symbols:
                symbol_list = ", ".join(symbols)
                raise ValueError(f"Unit '{name}' is not understood at '{token}'; known symbols are {symbol_list}.")
            power = sign * int(match[2] or 1)
            base, scale = symbols[match[1]]
            factor *= scale**power
            for symbol, exponent in base.items():
                exponents[symbol] += power * exponent
    return UnitDefinition({b: e for b, e in exponents.items() if e}, factor)
