"""Reads the text of a tyre property file: sections of keys and values, comments, tables."""

import math
import re
from collections.abc import Container
from dataclasses import dataclass, field
from pathlib import Path

from ali3.message_text import brief, one_line
from ali3.reading import read_bytes
from mbs.common.errors import ModelError

MAX_BYTES = 1_000_000
"""Usual files have some ten thousand bytes."""
_MAX_LINE_LENGTH = 1000  # characters
_SECTION = re.compile(r"\[\s*([A-Za-z0-9_]+)\s*\]")
_ENTRY = re.compile(r"([A-Za-z][A-Za-z0-9_]*)\s*=\s*(.*)")
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eEdD][+-]?\d+)?", re.ASCII)
_WITH_COMMA = re.compile(r"[+-]?\d+,\d+([eEdD][+-]?\d+)?", re.ASCII)


class TyreFileError(ModelError):
    """A tyre property file that cannot be read or does not describe a tyre; the message names the file."""


@dataclass(frozen=True)
class PropertyText:
    """Sections of a tyre property file."""

    name: str
    sections: dict[str, dict[str, str | float]] = field(default_factory=dict)
    """Words (without quotation marks) or numbers by section and key, all in capitals."""
    tables: frozenset[str] = frozenset()
    """Sections with lines of numbers."""

    def fault(self, sentence: str) -> TyreFileError:
        """Make an error that names the file."""
        return TyreFileError(f"{self.name}: {sentence}")

    def word(self, key: str, section: str) -> str:
        """Word of a key in capitals; empty if there is none."""
        return str(self.sections.get(section, {}).get(key, "")).upper()

    def numbers(self, expected: Container[str] = ()) -> dict[str, float]:
        """All numbers by key.

        `expected`: keys whose values must be numbers. Raises `TyreFileError` if a key has different values in two
        sections, or a text instead of a number.
        """
        numbers: dict[str, float] = {}
        for section, entries in self.sections.items():
            for key, value in entries.items():
                if not isinstance(value, float):
                    if key in expected:
                        raise self.fault(
                            f"{key} in [{section}] is the text {brief(value)}; it must be a number, without "
                            "quotation marks."
                        )
                    continue
                if numbers.setdefault(key, value) != value:
                    raise self.fault(f"{key} is {numbers[key]:g} in one section and {value:g} in another.")
        return numbers


def read_properties(file: str | Path) -> PropertyText:
    """Read the sections of a tyre property file. `file`: text in UTF-8 or Latin-1; keys and values are ASCII.

    Raises `TyreFileError` if it is not such a text.
    """
    data = read_bytes(file, MAX_BYTES, TyreFileError)
    if data.startswith((b"\xff\xfe", b"\xfe\xff")) or b"\0" in data:
        raise TyreFileError(f"{file} is not text of single bytes; it must be in UTF-8 or Latin-1.")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    if not text.strip():
        raise TyreFileError(f"{file} is empty; it must be a tyre property file.")
    return _parse(text, str(file))


def _parse(text: str, name: str) -> PropertyText:
    """Sections of a text. `name`: name of the file, for messages."""
    sections: dict[str, dict[str, str | float]] = {}
    tables: set[str] = set()
    section = ""
    for k, raw in enumerate(text.splitlines(), 1):
        where = f"{name}, line {k}"
        if len(raw) > _MAX_LINE_LENGTH:
            raise TyreFileError(f"{where} has {len(raw)} characters; it must have at most {_MAX_LINE_LENGTH}.")
        line = _without_comment(raw)
        if not line or line.startswith("{"):
            continue
        if heading := _SECTION.fullmatch(line):
            section = heading[1].upper()
            if section in sections and section not in ("SHAPE", "DEFLECTION_LOAD_CURVE", "BOTTOMING_CURVE"):
                raise TyreFileError(f"{where}: the section [{section}] stands twice.")
            sections.setdefault(section, {})
            continue
        if not section:
            raise TyreFileError(f"{where}: {brief(line)} is before any section; a section begins as [UNITS].")
        entry = _ENTRY.fullmatch(line)
        if entry is None:
            if not all(_NUMBER.fullmatch(part) for part in re.split(r"[\s,;]+", line)):
                raise TyreFileError(f"{where}: {brief(line)} is neither a section, a key with its value nor a comment.")
            tables.add(section)
            continue
        key, value = entry[1].upper(), _parse_value(entry[2].strip(), f"{where}: {entry[1].upper()}")
        if sections[section].setdefault(key, value) != value:
            raise TyreFileError(f"{where}: {key} stands twice in [{section}], with another value.")
    return PropertyText(name, sections, frozenset(tables))


def _without_comment(line: str) -> str:
    """Part of a line before its comment, which begins with `$` or `!` outside quotation marks."""
    quoted = ""
    for k, c in enumerate(line):
        if quoted:
            quoted = "" if c == quoted else quoted
        elif c in "'\"":
            quoted = c
        elif c in "$!":
            return line[:k].strip()
    return line.strip()


def _parse_value(text: str, subject: str) -> str | float:
    """Word or number of an entry. `subject`: file, line and key, for messages."""
    if text[:1] in ("'", '"'):
        if len(text) < 2 or text[-1] != text[0]:
            raise TyreFileError(f"{subject} is {brief(text)}; its quotation mark is not closed.")
        return text[1:-1].strip()
    if _WITH_COMMA.fullmatch(text):
        raise TyreFileError(
            f"{subject} is {brief(text)}; its decimal mark must be a point, as in {text.replace(',', '.')}."
        )
    if not _NUMBER.fullmatch(text):
        fault = f"{one_line(text, 60)}, without quotation marks" if text else "empty"
        raise TyreFileError(f"{subject} is {fault}; it must be a number, or a word in quotation marks.")
    number = float(re.sub("[dD]", "e", text))
    if not math.isfinite(number):
        raise TyreFileError(f"{subject} is {brief(text)}; it must be finite.")
    return number
