"""Limits on the size of files that are read; one environment variable scales all of them by a factor."""

import math
import os
from contextlib import suppress

from ali3.decimal_number import parse_number
from ali3.errors import UserError
from ali3.message_text import brief

VARIABLE = "ALI3_LIMITS"


def factor() -> float:
    """Factor of all limits. Raises `UserError`: the variable is not a number of at least 1."""
    text = os.environ.get(VARIABLE, "1")
    result = 0.0
    with suppress(ValueError):
        result = parse_number(text)
    if result < 1.0:
        raise UserError(f"The environment variable {VARIABLE} is {brief(text)}; it must be a number of at least 1.")
    return result


def raised(most: float) -> int:
    """A limit multiplied by the factor of the user."""
    return int(most * factor())


def at_most(size: float, most: float, form: str = "d") -> str:
    """The end of a sentence on a size above a limit, with the factor that would allow it. `form`: of the number."""
    return f"at most {format(raised(most), form)} (or {VARIABLE}={math.ceil(size / most)} set)"
