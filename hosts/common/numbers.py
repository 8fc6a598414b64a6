"""Values that a user writes, on the command line or in a file."""

import math
from numbers import Real
from typing import Any, TypeAlias

from ali3.decimal_number import parse_number

Value: TypeAlias = "float | int | bool | str"

LARGEST_NUMBER = 1e100
"""Of inputs and of what was measured: squares, sums and slopes of larger numbers are not finite."""


def parse_value(text: str) -> Value:
    """A number, ``true`` or ``false``, or a text in quotation marks; `ValueError` as for `parse_number`."""
    word = text.strip()
    if len(word) >= 2 and word[0] == word[-1] and word[0] in "\"'":
        return word[1:-1]
    return word == "true" if word in ("true", "false") else parse_number(word)


def is_finite(value: Any) -> bool:
    """Whether it is a finite real number of Python or NumPy; text and truth values are none."""
    try:
        return not isinstance(value, bool) and isinstance(value, Real) and math.isfinite(float(value))
    except OverflowError:
        return False


def or_null(value: float) -> float | None:
    """A number as JSON has it, which knows neither infinity nor NaN."""
    return float(value) if math.isfinite(value) else None


def is_round_off(change: float, size: float) -> bool:
    """Whether a change of a number of this size is within rounding and the solver's tolerance."""
    return abs(change) <= max(1e-9 * abs(size), 1e-12)


def text_of(value: Value) -> str:
    """The text of a value, as `parse_value` reads it."""
    if isinstance(value, bool):
        return str(value).lower()
    return f'"{value}"' if isinstance(value, str) else repr(value)
