"""Parses decimal numbers from text."""

import argparse
import math
import re

DECIMAL = r"(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?"
"""Pattern of a decimal number without its sign. Other texts that `float` accepts, such as 1_0 or digits of other
scripts, are more often typing errors than numbers."""

_NUMBER = re.compile(rf"[+-]?{DECIMAL}", re.ASCII)
_NOT_FINITE = re.compile(r"[+-]?(nan|inf|infinity)", re.IGNORECASE)


def parse_number(text: str) -> float:
    """A finite number. Raises `ValueError` with the text and the reason, to stand after a colon in a message."""
    word = text.strip()
    if _NOT_FINITE.fullmatch(word):
        raise ValueError(f"the value is {word}; only finite numbers can be used")
    if not _NUMBER.fullmatch(word):
        raise ValueError(f"{short(word)} is not a number")
    value = float(word)
    if not math.isfinite(value):
        raise ValueError(f"{short(word)} is too large for a number")
    return value


def number(text: str) -> float:
    """A number of the command line, which may be infinite or NaN."""
    try:
        return float(text) if _NOT_FINITE.fullmatch(text.strip()) else parse_number(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def short(text: str) -> str:
    """A word of the user in quotation marks, shortened to 40 characters."""
    return repr(text if len(text) <= 40 else text[:37] + "...")
