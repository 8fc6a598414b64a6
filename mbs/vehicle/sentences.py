"""From what the types refuse to sentences: key path, value, and what would be right."""

from __future__ import annotations

import datetime
import difflib
from collections.abc import Mapping, Sequence
from typing import Any

from pydantic import ValidationError

from mbs.common.checks import shown
from mbs.vehicle.key_paths import all_keys, annotation_at, item_of, keys_of, table_at, words
from mbs.vehicle.names import FORMS, NAME_WORDS
from mbs.vehicle.section import Section

CLOSE = 0.6  # of difflib: spellings that may be meant
LONGEST = 400  # characters of a sentence
ELSEWHERE = 3  # places of a key that a sentence names
UNKNOWN, MISSING = "extra_forbidden", "missing"
Loc = Sequence["int | str"]


class Sentences:
    """Says what is wrong with the content of a file.

    Parameters
    ----------
    top : type of Section
        The whole file.
    data : mapping
        Its content.
    """

    def __init__(self, top: type[Section], data: Mapping[str, Any]) -> None:
        self.top, self.data = top, data

    def of(self, error: ValidationError) -> list[str]:
        """A sentence for each fault; a key that is misspelt is not missing besides.

        Parameters
        ----------
        error : ValidationError
            Of the content.
        """
        items = sorted(error.errors(include_url=False), key=lambda item: item["type"] != UNKNOWN)
        missing = [self._path(item["loc"]) for item in items if item["type"] == MISSING]
        found, meant = [], []
        for item in items:
            if item["type"] == UNKNOWN:
                path = self._path(item["loc"])
                near = None if _key(path) in self._places(path) else self._near(path, _in_table(missing, path))
                meant += [[*path[:-1], near]] if near else []
                found.append(self._unknown(path, near))
            elif item["type"] != MISSING or self._path(item["loc"]) not in meant:
                found.append(self._sentence(item))
        gone = [self._missing(path) for path in meant]
        return [sentence for sentence in dict.fromkeys(found) if sentence not in gone]

    def _sentence(self, item: Any) -> str:
        kind, loc = item["type"], item["loc"]
        path = self._path(loc)
        if loc and loc[-1] == "[key]":
            return f"{_key(path[:-1])} has the name {shown(path[-1])}; a name is {NAME_WORDS}."
        if kind == MISSING and isinstance(loc[-1], str):
            return self._missing(path)
        if kind in ("union_tag_invalid", "union_tag_not_found"):
            known = item.get("ctx", {}).get("expected_tags")
            if known is None:
                return f"{_key([*path, 'kind'])} is missing; it names the template."
            return f"{_key([*path, 'kind'])} is {_given(_tag(item))}; it must be one of {known}."
        if kind == "quantity":
            return f"{self._place(path)} is {_given(item['input'])}; it must be {item['ctx']['range']}."
        if kind == MISSING:  # an element of a list that is too short
            path = path[:-1]
        if kind == "string_pattern_mismatch":
            return f"{_key(path)} is {_given(item['input'])}; it must be {FORMS[item['ctx']['pattern']]}."
        annotation = annotation_at(self.top, path, self.data)
        value: Any = self.data
        for key in path:
            value = item_of(value, key)
        right = "right" if annotation is None else words(annotation)
        return f"{self._place(path)} is {_given(value)}; it must be {right}{_limits(item)}."

    def _missing(self, path: Sequence[str]) -> str:
        table = table_at(self.top, path[:-1], self.data)
        if table is None:
            return f"{_key(path)} is missing."
        text = (keys_of(table)[path[-1]].description or "").rstrip(".").replace("\n", " ")
        right = words(annotation_at(self.top, path, self.data))
        return f"{_key(path)} is missing; it must be {right}: {text[:1].lower()}{text[1:]}."

    def _unknown(self, path: Sequence[str], near: str | None) -> str:
        if near is not None:
            return f"{_key(path)} is not known; did you mean '{near}'?"
        places = self._places(path)
        if places and _key(path) not in places:
            more = f" and {len(places) - ELSEWHERE} more" if len(places) > ELSEWHERE else ""
            return f"{_key(path)} is not known; '{path[-1]}' stands at {', '.join(places[:ELSEWHERE])}{more}."
        table = table_at(self.top, path[:-1], self.data)
        known = ", ".join(keys_of(table)) if table else "none"
        why = f"belongs to another kind than {shown(self._kind(path))}" if places else "is not known"
        return f"{_key(path)} {why}; the keys of {_key(path[:-1])} are {known}."

    def _places(self, path: Sequence[str]) -> list[str]:
        """Where a key of that name stands, in all templates."""
        return list(dict.fromkeys(p for p in all_keys(self.top) if p.split(".")[-1] == path[-1]))

    def _kind(self, path: Sequence[str]) -> Any:
        """Kind of the innermost template that a key is in."""
        here: Any = self.data
        kind = None
        for part in path[:-1]:
            here = item_of(here, part)
            kind = here.get("kind", kind) if isinstance(here, Mapping) else kind
        return kind

    def _near(self, path: Sequence[str], missing: Sequence[str]) -> str | None:
        """The key that is meant, first among those that are missing."""
        table = table_at(self.top, path[:-1], self.data)
        known = list(keys_of(table)) if table else []
        spelt = {key.lower(): key for key in reversed([*missing, *known])}
        for keys in ([k for k in spelt if spelt[k] in missing], list(spelt)):
            near = difflib.get_close_matches(path[-1].lower(), keys, 1, CLOSE)
            if near:
                return spelt[near[0]]
        return None

    def _path(self, loc: Loc) -> list[str]:
        """Key path of an error, without the names of templates and types that stand in it."""
        path: list[str] = []
        here: Any = self.data
        template: Any = None  # the table whose template stood in the path last
        for part in loc:
            if isinstance(here, Mapping) and part == here.get("kind") and here is not template:
                template = here  # a table may have a key of the same name as its template
            elif isinstance(here, Mapping) and part in here:
                path.append(str(part))
                here = here[part]
            elif isinstance(here, (list, tuple)) and isinstance(part, int):
                path.append(str(part))
                here = here[part] if part < len(here) else None
            elif part != "[key]" and isinstance(here, Mapping):
                path.append(str(part))
                here = None
        return path

    def _place(self, path: Sequence[str]) -> str:
        """A key path; the coordinates of a point with their axes."""
        if path and path[-1].isdigit() and int(path[-1]) < 3:
            whole = annotation_at(self.top, path[:-1], self.data)
            if whole is not None and words(whole).startswith("a list of 3 numbers, between -"):
                return f"{_key(path)} ({'xyz'[int(path[-1])]})"
        return _key(path)


def one_line(sentence: str) -> str:
    """A sentence whose names and values, which may be any text, neither break the line nor make it endless.

    Parameters
    ----------
    sentence : str
        With texts of a file in it.
    """
    printable = "".join(c if c.isprintable() else repr(c)[1:-1] for c in sentence)
    return printable if len(printable) <= LONGEST else f"{printable[: LONGEST // 2]} ... {printable[-LONGEST // 2 :]}"


def _in_table(paths: Sequence[Sequence[str]], path: Sequence[str]) -> list[str]:
    """Keys of those paths that lie in the same table as a path."""
    return [other[-1] for other in paths if other[:-1] == path[:-1]]


def _key(path: Sequence[str]) -> str:
    return ".".join(path) or "the file"


def _given(value: object) -> str:
    """A value as a sentence shows it: tables and lists of lists not at all, for they may be deep."""
    if isinstance(value, Mapping):
        return "a table"
    if isinstance(value, (list, tuple)):
        if any(isinstance(item, (list, tuple, Mapping)) for item in value):
            return f"a list of {len(value)} lists or tables"
        return shown(list(value))
    if isinstance(value, (datetime.date, datetime.time)):
        return f"a date or time, {value.isoformat()}"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int) and abs(value) >= 10**18:
        return "a whole number of 19 digits or more"
    return shown(value)


def _tag(item: Any) -> Any:
    """What stands as the kind of a template."""
    given = item["input"]
    return given.get("kind") if isinstance(given, Mapping) else item["ctx"]["tag"]


def _limits(item: Any) -> str:
    """What is asked of a text or a list besides its type."""
    context = item.get("ctx", {})
    if item["type"] == "string_too_long":
        return f" of at most {context['max_length']} characters"
    if item["type"] in ("string_too_short", "too_short"):
        return ", not empty"
    if item["type"] == "too_long" and "max_length" in context:
        return f", {context['max_length']} at most"
    return ""
