"""Numbers and other values that a user writes, on the command line or in a file."""

from __future__ import annotations

import argparse
import math
import re
from typing import TypeAlias

from ali3.decimal_number import DECIMAL

Value: TypeAlias = "float | int | bool | str"

_NUMBER = re.compile(rf"[+-]?{DECIMAL}", re.ASCII)
_NOT_FINITE = re.compile(r"[+-]?(nan|inf|infinity)", re.IGNORECASE)


def parse_number(text: str) -> float:
    """A finite number.

    Raises
    ------
    ValueError
        With the text and the reason, as the rest of a sentence after a colon.
    """
    word = text.strip()
    if _NOT_FINITE.fullmatch(word):
        raise ValueError(f"the value is {word}; only finite numbers can be used")
    if not _NUMBER.fullmatch(word):
        raise ValueError(f"{_short(word)} is not a number")
    value = float(word)
    if not math.isfinite(value):
        raise ValueError(f"{_short(word)} is too large for a number")
    return value


def parse_value(text: str) -> Value:
    """A number, ``true`` or ``false``, or a text in quotation marks; `ValueError` as for `parse_number`."""
    word = text.strip()
    if len(word) >= 2 and word[0] == word[-1] and word[0] in "\"'":
        return word[1:-1]
    return word == "true" if word in ("true", "false") else parse_number(word)


def number(text: str) -> float:
    """A number of the command line; whether it may be infinite or none at all depends on its use."""
    try:
        return float(text) if _NOT_FINITE.fullmatch(text.strip()) else parse_number(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def assignment(text: str) -> tuple[str, float]:
    """``NAME=VALUE`` of the command line."""
    name, value = name_and_text(text)
    return name, number(value)


def name_and_text(text: str) -> tuple[str, str]:
    """``NAME=VALUE`` of the command line, whose value the FMU's variable reads."""
    name, equals, value = text.partition("=")
    if not equals or not name.strip():
        raise argparse.ArgumentTypeError(f"{_short(text)} is not of the form NAME=VALUE")
    return name.strip(), value


def _short(text: str) -> str:
    return repr(text if len(text) <= 40 else text[:37] + "...")
