"""Tolerance of a run: of positions or of single sensors, with the check of what a caller gives."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from mbs.common.checks import is_finite, shown

LEAST_TOLERANCE = 1e-11
MOST_TOLERANCE = 0.5
DEFAULT_TOLERANCE = 1e-3
"""Of runs in equal steps that are chosen; at most what a run begins with whose tolerance is that of sensors."""


@dataclass(frozen=True)
class Tolerance:
    """Accepted error of a run."""

    share: float
    """Of positions, in parts of the model's length."""
    sensors: Mapping[str, float] = field(default_factory=dict)
    """Of sensors, in their units; they decide in place of positions."""


def checked_tolerance(tolerance: object, units: Mapping[str, str], length: float) -> Tolerance:
    """The tolerance of a run, or one sentence: a number, or numbers by sensor.

    `units`: of the sensors that the System computes, by name; `length`: of the model, m.
    """
    if isinstance(tolerance, Mapping):
        return _of_sensors(tolerance, units, length)
    value = float(tolerance) if is_finite(tolerance) else math.nan  # type: ignore[arg-type]
    if LEAST_TOLERANCE <= value <= MOST_TOLERANCE:
        return Tolerance(value)
    what = "it is below what round-off leaves; " if 0.0 < value < LEAST_TOLERANCE else ""
    raise ValueError(
        f"The tolerance is {shown(tolerance)}; {what}it must be a number between {LEAST_TOLERANCE:g} and "
        f"{MOST_TOLERANCE:g}: the largest error of positions in parts of the model's length; or errors of sensors in "
        "their units, by name."
    )


def _of_sensors(given: Mapping[object, object], units: Mapping[str, str], length: float) -> Tolerance:
    for name, value in given.items():
        if name not in units:
            raise ValueError(f"A tolerance is given for {shown(name)}; the System computes no such sensor.")
        if not (is_finite(value) and float(value) > 0.0):  # type: ignore[arg-type]
            raise ValueError(f"The tolerance of {name!r} is {shown(value)}; it must be a number above 0.")
    if not given:
        raise ValueError("The tolerance names no sensor; give one error by name, or a number.")
    allowed = {str(name): float(value) for name, value in given.items()}  # type: ignore[arg-type]
    shares = [value / length for name, value in allowed.items() if units[name] == "m"]
    return Tolerance(min(max(min(shares, default=DEFAULT_TOLERANCE), LEAST_TOLERANCE), DEFAULT_TOLERANCE), allowed)
