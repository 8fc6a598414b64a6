"""Measures of left and right turns combined: mean and asymmetry."""

import math

from hosts.common.display_units import shown_in
from hosts.common.numbers import is_round_off
from hosts.measures.measure import Measure

_TOLERANCE = 0.05
NOT_SHOWN = "The runs do not show it."


def mean_of_sides(
    name: str,
    left: float,
    right: float,
    unit: str,
    text: str,
    reason: str = "",
    exists: bool = True,
) -> Measure:
    """Mean of left and right, with a note if they differ by more than 5 %, or one is missing.

    `left`, `right`: NaN if a run does not yield it; `reason`: note if both are missing; `exists`: whether the number
    exists if both are missing.
    """
    finite = [x for x in (left, right) if math.isfinite(x)]
    if not finite:
        return Measure(name, math.nan, unit, text, None, reason or NOT_SHOWN, exists)
    mean = sum(finite) / len(finite)
    note = ""
    if len(finite) == 1:
        note = f"Of the turn to the {'left' if math.isfinite(left) else 'right'} alone: the other does not show it."
    elif abs(left - right) > _TOLERANCE * abs(mean):
        unit_text, factor = shown_in(unit, name)
        note = f"Left {factor * left:.4g}, right {factor * right:.4g}{'' if unit_text == '1' else f' {unit_text}'}."
    return Measure(name, mean, unit, text, None, note)


def asymmetry(name: str, left: float, right: float, text: str, reason: str = "") -> Measure:
    """Absolute difference of left and right over their mean. `reason`: note if one is missing."""
    value = math.nan
    if math.isfinite(left + right) and left + right != 0.0:
        value = 0.0 if is_round_off(left - right, left) else abs(left - right) / (0.5 * abs(left + right))
    note = "" if math.isfinite(value) else reason or "There are no runs to both sides."
    return Measure(name, value, "1", text, None, note)
