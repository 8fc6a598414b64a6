"""What Pydantic finds wrong with a file, as one sentence: the key, its value, and what would be right."""

from __future__ import annotations

import difflib
import typing
from collections.abc import Sequence
from typing import Any

from pydantic import BaseModel, ValidationError

_LONGEST = 60


def sentence(error: ValidationError, model: type[BaseModel]) -> str:
    """The first of the errors.

    Parameters
    ----------
    error : ValidationError
    model : type
        What was read; the descriptions of its fields say what would be right.
    """
    errors = error.errors(include_url=False)
    # a key that is not known explains one that is missing
    first = next((e for e in errors if e["type"] == "extra_forbidden"), errors[0])
    place, kind = first["loc"], first["type"]
    if kind == "extra_forbidden":
        known = sorted(_holder(model, place).model_fields)
        near = difflib.get_close_matches(str(place[-1]), known, 1)
        hint = f"did you mean {near[0]}?" if near else f"known are {', '.join(known)}."
        return f"there is no key {_path(model, place)}; {hint}"
    key, wanted = _path(model, place), _description(model, place)
    if kind == "value_error":
        words = str(first["ctx"]["error"])
        return f"{key}: {words}." if key else f"{words}."
    if kind == "missing":
        return f"{key} is missing: {wanted}."
    return f"{key} is {_short(first['input'])}; it must be {wanted or first['msg']}."


def _short(value: object) -> str:
    text = repr(value)
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 3]}..."


def _models(annotation: Any) -> list[type[BaseModel]]:
    """Models in an annotation, such as that of `list[Entry] | None`."""
    if typing.get_origin(annotation) is None and isinstance(annotation, type):
        return [annotation] if issubclass(annotation, BaseModel) else []
    return [model for part in typing.get_args(annotation) for model in _models(part)]


def _walk(model: type[BaseModel], place: Sequence[int | str]) -> list[tuple[type[BaseModel], str | int]]:
    """Model and key of each part of a place that the user has written; parts of Pydantic's own are left out."""
    steps: list[tuple[type[BaseModel], str | int]] = []
    here, inner = model, False
    for part in place:
        steps.append((here, part))
        if inner and _models_of(steps):  # the number in a list, or the name in a table of tables
            inner = False
            continue
        field = here.model_fields.get(str(part))
        if inner or field is None:
            break
        models, many = _models(field.annotation), typing.get_origin(field.annotation) in (list, dict)
        if not models and not many:
            break
        inner, here = many, models[0] if models else here
    return steps


def _models_of(steps: Sequence[tuple[type[BaseModel], str | int]]) -> bool:
    """Whether the part before the last holds models, not plain values."""
    holder, part = steps[-2]
    return bool(_models(holder.model_fields[str(part)].annotation))


def _holder(model: type[BaseModel], place: Sequence[int | str]) -> type[BaseModel]:
    return _walk(model, place)[-1][0]


def _path(model: type[BaseModel], place: Sequence[int | str]) -> str:
    text = ""
    for _, part in _walk(model, place):
        if isinstance(part, int):
            text += f"[{part + 1}]"  # people count from 1
        else:
            name = part if part.replace("_", "").isalnum() else f"'{part}'"
            text += f".{name}" if text else name
    return text


def _description(model: type[BaseModel], place: Sequence[int | str]) -> str:
    for holder, part in reversed(_walk(model, place)):
        if part in holder.model_fields:
            return holder.model_fields[str(part)].description or ""
    return ""
