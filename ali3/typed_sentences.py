"""Writes a sentence for each error of a typed file: key path, value, and what would be right."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from pydantic import ValidationError

from ali3.columns import some_of
from ali3.message_text import one_line, value_text
from ali3.near_names import near_names
from ali3.typed_paths import (
    all_keys,
    annotation_at,
    holds_keys,
    item_of,
    key_type_of,
    keys_of,
    kinds_of,
    table_at,
    templates,
    title_of,
    words,
)

ELSEWHERE = 3  # locations of a key that a sentence names
UNKNOWN = "extra_forbidden"
MISSING = "missing"
Loc = Sequence["int | str"]
NOTHING: Mapping[str, str] = {}


def dotted(path: Sequence[str]) -> str:
    """A key path as in TOML: keys that are not bare in quotation marks, list indices from 0."""
    return ".".join(part if part.replace("-", "_").isidentifier() or part.isdigit() else f"'{part}'" for part in path)


class Sentences:
    """Writes sentences on the faults of the content of a file.

    Parameters
    ----------
    top : type
        The whole file: a model, or several of which the key ``kind`` chooses one.
    forms : mapping of str to str
        Descriptions of texts by pattern.
    names : str
        Description of names that the user chooses.
    place : callable
        Text of a key path, whose parts are keys, and list indices from 0 as text.
    """

    def __init__(
        self,
        top: Any,
        data: Mapping[str, Any],
        forms: Mapping[str, str] = NOTHING,
        names: str = "text",
        place: Callable[[Sequence[str]], str] = dotted,
    ) -> None:
        self.top, self.data, self.forms, self.names = top, data, forms, names
        self._words_of = place

    def place(self, path: Sequence[str]) -> str:
        """The location of a key in the file."""
        return self._words_of(path) or "the file"

    def of(self, error: ValidationError) -> list[str]:
        """A sentence for each fault; the right key of a misspelt one is not reported as missing too."""
        items = sorted(error.errors(include_url=False), key=lambda item: item["type"] != UNKNOWN)
        missing = [self._path(item["loc"]) for item in items if item["type"] == MISSING]
        sentences, misspelt_paths = [], []
        for item in items:
            if item["type"] == UNKNOWN:
                path = self._path(item["loc"])
                near = None if self.place(path) in self._places(path) else self._near(path, _in_table(missing, path))
                misspelt_paths += [[*path[:-1], near]] if near else []
                sentences.append(self._unknown(path, near))
            elif item["type"] != MISSING or self._path(item["loc"]) not in misspelt_paths:
                sentences.append(self._sentence(item))
        replaced_sentences = [self._missing(path) for path in misspelt_paths]
        return [one_line(sentence) for sentence in dict.fromkeys(sentences) if sentence not in replaced_sentences]

    def _sentence(self, item: Any) -> str:
        kind, loc = item["type"], item["loc"]
        path = self._path(loc)
        if loc and loc[-1] == "[key]":
            requirement = words(key_type_of(annotation_at(self.top, path[:-1], self.data)))
            requirement = self.names if requirement == "text" else requirement
            return f"{self.place(path[:-1])} has the name {value_text(path[-1])}; a name is {requirement}."
        if kind == MISSING and isinstance(loc[-1], str):
            return self._missing(path)
        if kind == "value_error":  # of a rule between several keys
            return f"{self.place(path)}: {item['ctx']['error']}." if path else f"{item['ctx']['error']}."
        if kind in ("union_tag_invalid", "union_tag_not_found"):
            tables = templates(annotation_at(self.top, path, self.data))
            known_names = ", ".join(repr(name) for table in tables for name in kinds_of(table))
            if kind == "union_tag_not_found":
                return f"{self.place([*path, 'kind'])} is missing; it must be one of {known_names}."
            return f"{self.place([*path, 'kind'])} is {value_text(_tag(item))}; it must be one of {known_names}."
        if kind == "quantity":
            return f"{self._coordinate(path)} is {value_text(item['input'])}; it must be {item['ctx']['range']}."
        if kind == MISSING:  # an element of a list that is too short
            path = path[:-1]
        if kind == "string_pattern_mismatch":
            return f"{self.place(path)} is {value_text(item['input'])}; it must be {self._form(item)}."
        annotation = annotation_at(self.top, path, self.data)
        value: Any = self.data
        for key in path:
            value = item_of(value, key)
        requirement = "right" if annotation is None else words(annotation)
        limits = "" if title_of(annotation) else _limits(item)
        return f"{self._coordinate(path)} is {value_text(value)}; it must be {requirement}{limits}."

    def _form(self, item: Any) -> str:
        """Description of the texts that match a pattern."""
        pattern = item["ctx"]["pattern"]
        annotation = annotation_at(self.top, self._path(item["loc"]), self.data)
        return self.forms.get(pattern) or title_of(annotation) or f"text of the form {pattern}"

    def _missing(self, path: Sequence[str]) -> str:
        table = table_at(self.top, path[:-1], self.data)
        if table is None:
            return f"{self.place(path)} is missing."
        text = (keys_of(table)[path[-1]].description or "").rstrip(".").replace("\n", " ")
        requirement = words(annotation_at(self.top, path, self.data))
        meaning = f": {text[:1].lower()}{text[1:]}" if text else ""
        return f"{self.place(path)} is missing; it must be {requirement}{meaning}."

    def _unknown(self, path: Sequence[str], near: str | None) -> str:
        if near is not None:
            return f"{self.place(path)} is not known; did you mean '{near}'?"
        locations = self._places(path)
        if locations and self.place(path) not in locations:
            return f"{self.place(path)} is not known; '{path[-1]}' stands at {some_of(locations, ELSEWHERE)}."
        table = table_at(self.top, path[:-1], self.data)
        known_names = ", ".join(keys_of(table)) if table else "none"
        fault = f"belongs to another kind than {value_text(self._kind(path))}" if locations else "is not known"
        return f"{self.place(path)} {fault}; the keys of {self.place(path[:-1])} are {known_names}."

    def _places(self, path: Sequence[str]) -> list[str]:
        """Key paths with the same last key, in all templates."""
        keys = (key for table in templates(self.top) for key in all_keys(table))
        return list(dict.fromkeys(key for key in keys if key.split(".")[-1] == path[-1]))

    def _kind(self, path: Sequence[str]) -> Any:
        """Kind of the innermost template that contains a key."""
        node: Any = self.data
        kind = None
        for part in path[:-1]:
            node = item_of(node, part)
            kind = node.get("kind", kind) if isinstance(node, Mapping) else kind
        return kind

    def _near(self, path: Sequence[str], missing: Sequence[str]) -> str | None:
        """The intended key, if possible one of the missing keys."""
        table = table_at(self.top, path[:-1], self.data)
        known_names = list(keys_of(table)) if table else []
        near = near_names(path[-1], missing, 1) or near_names(path[-1], known_names, 1)
        return near[0] if near else None

    def _path(self, loc: Loc) -> list[str]:
        """Key path of an error, without the names of templates and types that pydantic adds."""
        path: list[str] = []
        node: Any = self.data
        template: Any = None  # the last table whose template was in the path
        for part in loc:
            if isinstance(node, Mapping) and part == node.get("kind") and node is not template:
                template = node  # a table may have a key of the same name as its template
            elif isinstance(node, Mapping) and part in node:
                path.append(str(part))
                node = node[part]
            elif isinstance(node, (list, tuple)) and isinstance(part, int):
                path.append(str(part))
                node = node[part] if part < len(node) else None
            elif part != "[key]" and isinstance(node, Mapping) and holds_keys(self.top, path, self.data):
                path.append(str(part))
                node = None
        return path

    def _coordinate(self, path: Sequence[str]) -> str:
        """A key path; for a coordinate of a point with its axis."""
        if path and path[-1].isdigit() and int(path[-1]) < 3:
            list_type = annotation_at(self.top, path[:-1], self.data)
            if list_type is not None and words(list_type).startswith("a list of 3 numbers, between -"):
                return f"{self.place(path)} ({'xyz'[int(path[-1])]})"
        return self.place(path)


def _in_table(paths: Sequence[Sequence[str]], path: Sequence[str]) -> list[str]:
    """Last keys of those paths that are in the same table as a path."""
    return [other[-1] for other in paths if other[:-1] == path[:-1]]


def _tag(item: Any) -> Any:
    """The faulty kind of a template."""
    entry = item["input"]
    return entry.get("kind") if isinstance(entry, Mapping) else item["ctx"]["tag"]


def _limits(item: Any) -> str:
    """Limits of a text or list beyond its type."""
    context = item.get("ctx", {})
    if item["type"] == "string_too_long":
        return f" of at most {context['max_length']} characters"
    if item["type"] in ("string_too_short", "too_short"):
        return f", at least {context['min_length']}" if context.get("min_length", 1) > 1 else ", not empty"
    if item["type"] == "too_long" and "max_length" in context:
        return f", {context['max_length']} at most"
    return ""
