"""Formats values and sentences for messages: in one line, shortened if they are long."""

import datetime
import math
import re
from collections.abc import Iterable, Mapping, Sequence

VALUE = 60  # characters of a value in a sentence
SENTENCE = 400  # characters of a sentence that quotes a file
_MAX_WORD = 240  # characters of the longest word that is not shortened
_MAX_MESSAGE = 2000  # characters of the longest message that is not shortened
_FORBIDDEN_IN_XML = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ufffe\uffff\ud800-\udfff]")


def brief(value: object) -> str:
    """A value for a sentence: text in quotes with escaped control characters, and only the first `VALUE` characters."""
    if isinstance(value, str):
        value = value[: VALUE + 1]  # escaping the rest of a large text would take long
    elif isinstance(value, int) and value.bit_length() > 64:
        return "a whole number of more than 19 digits"  # Python does not print very long ones
    text = re.sub(r"\n\s*", " ", repr(value))  # an array in one line
    return text if len(text) <= VALUE else f"{text[:VALUE]}..."


def clean(text: str) -> str:
    """Text without characters that XML forbids."""
    return _FORBIDDEN_IN_XML.sub("\ufffd", text)


def value_text(value: object) -> str:
    """A value of a file for a sentence; tables and nested lists, which may be deep, only by their kind."""
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
    """A sentence with a limited length of each word and of the whole, without control characters for terminals."""
    sentence = _escaped(sentence, retained="\n\t")
    sentence = re.sub(rf"\S{{{_MAX_WORD + 1},}}", lambda match: f"{match[0][:100]}...{match[0][-60:]}", sentence)
    return _cut(sentence, _MAX_MESSAGE)


def one_line(sentence: str, most: int = SENTENCE) -> str:
    """A sentence without line breaks and of limited length, whatever texts it quotes."""
    return _cut(_escaped(_cut(sentence, most)), most)  # first cut, as escaping a large text would take long


def _cut(text: str, most: int) -> str:
    """The first and the last characters of a text of more than `most` characters."""
    return text if len(text) <= most else f"{text[: most // 2]} ... {text[-most // 2 :]}"


def _escaped(text: str, retained: str = "") -> str:
    """A text with escape sequences for control characters that are not in `retained`."""
    return "".join(c if c.isprintable() or c in retained else repr(c)[1:-1] for c in text)


def sentence_of(message: str) -> str:
    """The message with a capital and a full stop; empty if it is empty."""
    return f"{message[0].upper()}{message[1:]}." if message else ""


def place_text(path: Iterable[int | str]) -> str:
    """Keys and list indices from 0 as a path, such as ``shapes[3].radius`` or ``frames['wheel FL'].axis``."""
    text = ""
    for key in path:
        if isinstance(key, int):
            text += f"[{key}]"
        elif key.replace("-", "_").isidentifier():
            text += f".{key}" if text else key
        else:
            text += f"[{brief(key)}]"
    return text


def word_list(words: Sequence[str], conjunction: str = "and") -> str:
    """``a``, ``a and b``, ``a, b and c``; empty without words."""
    return f" {conjunction} ".join([", ".join(words[:-1]), *words[-1:]] if len(words) > 1 else words)


def unit_text(unit: str) -> str:
    """A unit with a blank before it; empty for numbers without a unit."""
    return "" if unit in ("", "1") else f" {unit}"


def range_text(low: float, high: float, unit: str) -> str:
    """A range in words; empty if both ends are open.

    `low`, `high`: infinite if open; `unit`: "1" if there is none.
    """
    unit_suffix = unit_text(unit)
    if math.isinf(low):
        return "" if math.isinf(high) else f"up to {high:.10g}{unit_suffix}"
    return f"from {low:.10g}{unit_suffix}" if math.isinf(high) else f"{low:.10g} to {high:.10g}{unit_suffix}"
