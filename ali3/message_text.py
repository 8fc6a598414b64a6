"""Formats values and sentences for messages: in one line, shortened if they are long."""

import datetime
import math
import re
from collections.abc import Iterable, Mapping

VALUE = 60  # characters of a value in a sentence
SENTENCE = 400  # characters of a sentence with texts of a file in it
_WORD = 240  # longest word that is shown as it is
_MESSAGE = 2000  # longest message that is shown as it is
_FORBIDDEN = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ufffe\uffff\ud800-\udfff]")  # by XML


def brief(value: object) -> str:
    """A value in a sentence: text in quotes, control characters escaped, and the beginning of what is long."""
    if isinstance(value, str):
        value = value[: VALUE + 1]  # the rest of a large text need not be escaped
    elif isinstance(value, int) and value.bit_length() > 64:
        return "a whole number of more than 19 digits"  # Python refuses to write a very long one
    text = re.sub(r"\n\s*", " ", repr(value))  # of an array in one line
    return text if len(text) <= VALUE else f"{text[:VALUE]}..."


def clean(text: str) -> str:
    """Text without characters that a document cannot have."""
    return _FORBIDDEN.sub("\ufffd", text)


def value_text(value: object) -> str:
    """A value of a file in a sentence: tables and lists of lists not at all, for they may be deep."""
    if isinstance(value, Mapping):
        return "a table"
    if isinstance(value, (list, tuple)):
        if any(isinstance(item, (list, tuple, Mapping)) for item in value):
            return f"a list of {len(value)} lists or tables"
        return brief(list(value))
    if isinstance(value, (datetime.date, datetime.time)):
        return f"a date or time, {value.isoformat()}"
    if isinstance(value, bool):
        return str(value).lower()
    return "null" if value is None else brief(value)


def shortened(sentence: str) -> str:
    """A sentence in which texts without a blank, such as values and paths, and the whole have an end, and nothing tells
    a terminal what to do.
    """
    sentence = "".join(c if c.isprintable() or c in "\n\t" else repr(c)[1:-1] for c in sentence)
    sentence = re.sub(rf"\S{{{_WORD},}}", lambda match: f"{match[0][:100]}...{match[0][-60:]}", sentence)
    return sentence if len(sentence) <= _MESSAGE else f"{sentence[: _MESSAGE // 2]} ... {sentence[-_MESSAGE // 2 :]}"


def one_line(sentence: str, most: int = SENTENCE) -> str:
    """A sentence whose names and values, which may be any text, neither break the line nor make it endless."""
    if len(sentence) > most:
        sentence = f"{sentence[: most // 2]} ... {sentence[-most // 2 :]}"
    return "".join(c if c.isprintable() else repr(c)[1:-1] for c in sentence)


def sentence_of(message: str) -> str:
    """Words that are the end of a sentence as a whole one: with a capital and a full stop; nothing of nothing."""
    return f"{message[0].upper()}{message[1:]}." if message else ""


def place_text(path: Iterable[int | str]) -> str:
    """Keys and places from 0 in lists as a path, such as ``shapes[3].radius`` or ``frames['wheel FL'].axis``."""
    text = ""
    for part in path:
        if isinstance(part, int):
            text += f"[{part}]"
        elif part.replace("-", "_").isidentifier():
            text += f".{part}" if text else part
        else:
            text += f"[{brief(part)}]"
    return text


def unit_text(unit: str) -> str:
    """A unit behind a number: nothing for pure numbers."""
    return "" if unit in ("", "1") else f" {unit}"


def range_text(low: float, high: float, unit: str) -> str:
    """A range for a person, empty where both ends are open.

    `low`, `high`: infinite where open; `unit`: "1" where there is none.
    """
    unit_suffix = unit_text(unit)
    if math.isinf(low):
        return "" if math.isinf(high) else f"up to {high:.10g}{unit_suffix}"
    return f"from {low:.10g}{unit_suffix}" if math.isinf(high) else f"{low:.10g} to {high:.10g}{unit_suffix}"
