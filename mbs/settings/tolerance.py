"""Tolerance of a run, of positions or of single sensors, and its check."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from mbs.common.checks import is_finite, shown

MIN_TOLERANCE = 1e-11
MAX_TOLERANCE = 0.5
DEFAULT_TOLERANCE = 1e-3
"""Tolerance of runs with chosen equal steps, and largest one of positions in runs with tolerances of sensors."""


@dataclass(frozen=True)
class Tolerance:
    """Accepted error of a run."""

    position: float
    """Largest error of positions relative to the length of the model."""
    sensors: Mapping[str, float] = field(default_factory=dict)
    """Largest errors of sensors, in their units, by name; they replace the error of positions."""


def check_tolerance(tolerance: object, units: Mapping[str, str], length: float) -> Tolerance:
    """Return the tolerance of a run, given as a number or as numbers by sensor.

    `units`: units of the sensors that the System computes, by name; `length`: length of the model, m. Raises
    `ValueError` if the tolerance is not valid.
    """
    if isinstance(tolerance, Mapping):
        return _check_sensor_tolerances(tolerance, units, length)
    value = float(tolerance) if is_finite(tolerance) else math.nan  # type: ignore[arg-type]
    if MIN_TOLERANCE <= value <= MAX_TOLERANCE:
        return Tolerance(value)
    reason = "it is below what round-off leaves; " if 0.0 < value < MIN_TOLERANCE else ""
    raise ValueError(
        f"The tolerance is {shown(tolerance)}; {reason}it must be a number between {MIN_TOLERANCE:g} and "
        f"{MAX_TOLERANCE:g}: the largest error of positions in parts of the model's length; or errors of sensors in "
        "their units, by name."
    )


def _check_sensor_tolerances(tolerances: Mapping[object, object], units: Mapping[str, str], length: float) -> Tolerance:
    for name, value in tolerances.items():
        if name not in units:
            raise ValueError(f"A tolerance is given for {shown(name)}; the System computes no such sensor.")
        if not (is_finite(value) and float(value) > 0.0):  # type: ignore[arg-type]
            raise ValueError(f"The tolerance of {name!r} is {shown(value)}; it must be a number above 0.")
    if not tolerances:
        raise ValueError("The tolerance names no sensor; give one error by name, or a number.")
    errors = {str(name): float(value) for name, value in tolerances.items()}  # type: ignore[arg-type]
    positions = [value / length for name, value in errors.items() if units[name] == "m"]
    return Tolerance(min(max(min(positions, default=DEFAULT_TOLERANCE), MIN_TOLERANCE), DEFAULT_TOLERANCE), errors)
