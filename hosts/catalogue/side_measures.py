"""Measures combined from left and right: mean and asymmetry."""

import math

from hosts.common.display_units import shown_in
from hosts.common.numbers import is_round_off
from hosts.measures.measure import Measure

_SAME = 0.05
NOT_SHOWN = "The runs do not show it."


def mean_of_sides(
    name: str,
    left: float,
    right: float,
    unit: str,
    text: str,
    why: str = "",
    exists: bool = True,
) -> Measure:
    """Mean of left and right; the note says so where they differ by more than 5 %, or one is missing.

    `left`, `right`: NaN where a run does not yield it; `why`: note where both are missing; `exists`: whether there
    should be a number where both are.
    """
    finite = [x for x in (left, right) if math.isfinite(x)]
    if not finite:
        return Measure(name, math.nan, unit, text, None, why or NOT_SHOWN, exists)
    mean = sum(finite) / len(finite)
    note = ""
    if len(finite) == 1:
        note = f"Of the turn to the {'left' if math.isfinite(left) else 'right'} alone: the other does not show it."
    elif abs(left - right) > _SAME * abs(mean):
        tail, factor = shown_in(unit, name)
        note = f"Left {factor * left:.4g}, right {factor * right:.4g}{'' if tail == '1' else f' {tail}'}."
    return Measure(name, mean, unit, text, None, note)


def asymmetry(name: str, left: float, right: float, text: str, why: str = "") -> Measure:
    """Difference of left and right over their mean; `why`: note where one is missing."""
    value = math.nan
    if math.isfinite(left + right) and left + right != 0.0:
        value = 0.0 if is_round_off(left - right, left) else abs(left - right) / (0.5 * abs(left + right))
    note = "" if math.isfinite(value) else why or "There are no runs to both sides."
    return Measure(name, value, "1", text, None, note)
