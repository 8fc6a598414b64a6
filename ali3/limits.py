"""Limits of what is read, which one environment variable raises: all of them by one factor."""

import math
import os
from contextlib import suppress

from ali3.decimal_number import parse_number
from ali3.errors import UserError
from ali3.message_text import brief

VARIABLE = "ALI3_LIMITS"


def factor() -> float:
    """By how much limits are raised. Raises `UserError`: the variable is not a number of at least 1."""
    text = os.environ.get(VARIABLE, "1")
    found = 0.0
    with suppress(ValueError):
        found = parse_number(text)
    if found < 1.0:
        raise UserError(f"The environment variable {VARIABLE} is {brief(text)}; it must be a number of at least 1.")
    return found


def raised(most: float) -> int:
    """A limit as the user has raised it."""
    return int(most * factor())


def at_most(found: float, most: float, form: str = "d") -> str:
    """The end of a sentence on what is beyond a limit, with what would raise it. `form`: of the number."""
    return f"at most {format(raised(most), form)} (or {VARIABLE}={math.ceil(found / most)} set)"
