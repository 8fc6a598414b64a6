"""Bounds of the numbers of a tyre property file, SI units."""

from collections.abc import Mapping
from math import atan

from mbs.kernel.header.magic_coefficients import MAGIC_COEFFICIENTS
from mbs.tyre_files.property_text import PropertyText

_STIFFNESS = (1e3, 1e8, "N/m")
_PRESSURE = (1e3, 1e7, "Pa")
_LENGTH = (0.01, 3.0, "m")
_BOUNDS = {
    "UNLOADED_RADIUS": (0.05, 3.0, "m"),
    **dict.fromkeys(("WIDTH", "RIM_RADIUS", "RIM_WIDTH", "BOTTOMING_RADIUS"), _LENGTH),
    **dict.fromkeys(("FNOMIN", "FZMAX"), (10.0, 1e6, "N")),
    **dict.fromkeys(("VERTICAL_STIFFNESS", "LONGITUDINAL_STIFFNESS", "LATERAL_STIFFNESS"), _STIFFNESS),
    "BOTTOM_STIFF": (1e3, 1e10, "N/m"),
    "VERTICAL_DAMPING": (0.0, 1e6, "N s/m"),
    "LONGVL": (0.1, 200.0, "m/s"),
    **dict.fromkeys(("NOMPRES", "INFLPRES"), _PRESSURE),
    "FZMIN": (0.0, 1e6, "N"),
    **dict.fromkeys(("LTR", "LXAL", "LYKA", "LSGKP", "LSGAL", "LMY", "LMUV"), (0.0, 1e4, "")),
    **dict.fromkeys(("PCX1", "PCY1"), (-3.0, 3.0, "")),
    "Q_RE0": (0.8, 1.2, ""),
    "Q_V1": (-0.01, 0.01, ""),
    "Q_V2": (-0.1, 1.0, ""),
    "PFZ1": (-0.5, 3.0, ""),
    "QSY1": (-0.3, 0.3, ""),
    "QSY7": (0.0, 3.0, ""),
    "QSY8": (-3.0, 3.0, ""),
}
_RANGES = (("FZMIN", "FZMAX", "N"), ("PRESMIN", "PRESMAX", "Pa"))
_MAX_COEFFICIENT = 1e4  # the largest in public files is a PEY4 of 760
_COEFFICIENTS = (*MAGIC_COEFFICIENTS, "LCZ", "Q_FZ1", "Q_FZ2")


def check_bounds(text: PropertyText, numbers: Mapping[str, float]) -> None:
    """Raise `TyreFileError` if a number is outside its bounds; 0 counts as missing. `numbers`: numbers by key, SI
    units."""
    for key, value in numbers.items():
        if key not in _BOUNDS and key not in _COEFFICIENTS:
            continue
        least, most, unit = _BOUNDS.get(key, (-_MAX_COEFFICIENT, _MAX_COEFFICIENT, ""))
        if value and not least <= value <= most:
            suffix = f" {unit}" if unit else ""
            raise text.fault(f"{key} is {value:g}{suffix}; it must lie between {least:g} and {most:g}{suffix}.")
    for lower, upper, unit in _RANGES:
        least, most = (numbers.get(key, 0.0) for key in (lower, upper))
        if most and not least < most:
            raise text.fault(f"{lower} is {least:g} {unit} and {upper} {most:g} {unit}; the first must be the smaller.")
    ratio = numbers.get("DREFF", 0.0) * atan(numbers.get("BREFF", 0.0)) + numbers.get("FREFF", 0.0)
    if not 0.0 <= ratio <= 1.0:
        raise text.fault(
            f"DREFF atan(BREFF) + FREFF is {ratio:.3g}; under FNOMIN it is the distance from the free to "
            "the rolling radius over the deflection and must lie between 0 and 1."
        )
