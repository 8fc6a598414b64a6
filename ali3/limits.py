"""Limits on the size of files that are read; one environment variable scales all of them by a factor."""

import math
import os

from ali3.decimal_number import parse_number
from ali3.errors import UserError
from ali3.message_text import brief

VARIABLE = "ALI3_LIMITS"


def limit_factor() -> float:
    """Factor of all limits. Raises `UserError` if the variable is not a number of at least 1."""
    text = os.environ.get(VARIABLE, "1")
    try:
        result = parse_number(text)
    except ValueError:
        result = 0.0
    if result < 1.0:
        raise UserError(f"The environment variable {VARIABLE} is {brief(text)}; it must be a number of at least 1.")
    return result


def raised(limit: float) -> int:
    """The limit times the factor of the user."""
    return int(limit * limit_factor())


def at_most(size: float, limit: float, format_spec: str = "d") -> str:
    """End of a message about a size above a limit: the limit, and the value of the variable that would allow it."""
    return f"at most {format(raised(limit), format_spec)} (or {VARIABLE}={math.ceil(size / limit)} set)"
