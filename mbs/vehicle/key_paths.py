"""Key paths of a car file, seen in the types: which table stands where, and what a key must be."""

from __future__ import annotations

import types
from collections.abc import Iterator, Mapping, Sequence
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from annotated_types import Ge, Le
from pydantic.fields import FieldInfo

from mbs.vehicle.quantities import Quantity
from mbs.vehicle.section import Section

NOTHING = type(None)


def keys_of(table: type[Section]) -> dict[str, FieldInfo]:
    """Fields of a table by their keys in the file.

    Parameters
    ----------
    table : type of Section
        The table.
    """
    return {field.alias or name: field for name, field in table.model_fields.items()}


def annotation_of(field: FieldInfo) -> Any:
    """Type of a field with what is annotated to it.

    Parameters
    ----------
    field : FieldInfo
        Of a table.
    """
    return Annotated[(field.annotation, *field.metadata)] if field.metadata else field.annotation


def templates(annotation: Any) -> list[type[Section]]:
    """Tables that may stand at a key; several where templates are chosen by `kind`.

    Parameters
    ----------
    annotation : type
        Of the field.
    """
    if isinstance(annotation, type) and issubclass(annotation, Section):
        return [annotation]
    if get_origin(annotation) in (Annotated, Union, types.UnionType):
        return [t for inner in get_args(annotation) for t in templates(inner)]
    return []


def by_name(annotation: Any) -> Any | None:
    """What stands under each name of a table whose keys are names that the user chooses, None where it is no such.

    Parameters
    ----------
    annotation : type
        Of the field.
    """
    if get_origin(annotation) is dict:
        return get_args(annotation)[1]
    if get_origin(annotation) in (Annotated, Union, types.UnionType):
        return next((found for inner in get_args(annotation) if (found := by_name(inner)) is not None), None)
    return None


def kinds_of(table: type[Section]) -> tuple[str, ...]:
    """Values of `kind` that name a template; empty where it has none.

    Parameters
    ----------
    table : type of Section
        The template.
    """
    return get_args(table.model_fields["kind"].annotation) if "kind" in table.model_fields else ()


def annotation_at(top: type[Section], path: Sequence[str], data: Any) -> Any | None:
    """Type of what stands at a key path, None where the types have nothing there.

    Parameters
    ----------
    top : type of Section
        The whole file.
    path : sequence of str
        Keys from the top.
    data : mapping
        The file's content, which says the kinds of templates.
    """
    annotation: Any = top
    for key in path:
        inner = by_name(annotation)
        if inner is not None:
            annotation, data = inner, item_of(data, key)
            continue
        table = chosen(annotation, data)
        if table is not None:
            field = keys_of(table).get(key)
            if field is None:
                return None
            annotation = annotation_of(field)
        else:
            annotation = _element(annotation, key)
            if annotation is None:
                return None
        data = item_of(data, key)
    return annotation


def chosen(annotation: Any, data: Any) -> type[Section] | None:
    """The table among those of a type that the data name by `kind`.

    Parameters
    ----------
    annotation : type
        Of the field.
    data : object
        What the file has there.
    """
    found = templates(annotation)
    if len(found) == 1:
        return found[0]
    kind = data.get("kind") if isinstance(data, Mapping) else None
    return next((table for table in found if kind in kinds_of(table)), None)


def table_at(top: type[Section], path: Sequence[str], data: Any) -> type[Section] | None:
    """Table at a key path, None where there is none.

    Parameters
    ----------
    top : type of Section
        The whole file.
    path : sequence of str
        Keys from the top.
    data : mapping
        The file's content, which says the kinds of templates.
    """
    here = data
    for key in path:
        here = item_of(here, key)
    return chosen(annotation_at(top, path, data), here)


def all_keys(table: type[Section], path: str = "") -> Iterator[str]:
    """Key paths of a table and all in it, of all templates.

    Parameters
    ----------
    table : type of Section
        The table.
    path : str
        Where it stands.
    """
    for key, field in keys_of(table).items():
        place = f"{path}.{key}" if path else key
        yield place
        inner = by_name(field.annotation)
        for below in templates(field.annotation if inner is None else inner):
            yield from all_keys(below, place if inner is None else f"{place}.NAME")


def words(annotation: Any) -> str:
    """What a value of a type is, in words.

    Parameters
    ----------
    annotation : type
        With what is annotated to it.
    """
    if templates(annotation) or by_name(annotation) is not None:
        return "a table"
    quantity = next((item for item in _metadata(annotation) if isinstance(item, Quantity)), None)
    if quantity is not None:
        return f"a number, {quantity.range}"
    origin, inner = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        limits = [item for item in inner[1:] if isinstance(item, Ge | Le)]
        nested = [m for item in inner[1:] if isinstance(item, FieldInfo) for m in item.metadata]
        low = next((item.ge for item in [*limits, *nested] if isinstance(item, Ge)), None)
        high = next((item.le for item in [*limits, *nested] if isinstance(item, Le)), None)
        return words(inner[0]) + (f" from {low} to {high}" if low is not None and high is not None else "")
    if origin in (Union, types.UnionType):
        return " or ".join(dict.fromkeys(words(item) for item in inner if item is not NOTHING))
    if origin is Literal:
        return " or ".join(map(repr, inner))
    if origin is tuple:
        return _list_words(inner)
    return {str: "text", int: "a whole number", float: "a number", bool: "true or false"}.get(annotation, "a value")


def _list_words(inner: tuple[Any, ...]) -> str:
    if inner[-1] is not Ellipsis and any(item != inner[0] for item in inner):
        return f"a list of {' and '.join(words(item) for item in inner)}"
    each = words(inner[0])
    first, _, rest = each.partition(" of ")
    plural = {"a list": "lists", "text": "texts", "a table": "tables"}.get(first, first.replace("a number", "numbers"))
    plural += f" of {rest}" if rest else ""
    if inner[-1] is Ellipsis:
        return f"a list of {plural}"
    return f"a list of {len(inner)} {plural}"


def _metadata(annotation: Any) -> tuple[Any, ...]:
    return getattr(annotation, "__metadata__", ())


def item_of(data: Any, key: str) -> Any:
    """What stands under a key of a table or at a place of a list; None where nothing does.

    Parameters
    ----------
    data : object
        Table or list.
    key : str
        Key, or place from 0.
    """
    if isinstance(data, Mapping):
        return data.get(key)
    if isinstance(data, (list, tuple)) and key.isdigit() and int(key) < len(data):
        return data[int(key)]
    return None


def _element(annotation: Any, key: str) -> Any | None:
    """Type of an element of a list."""
    origin, inner = get_origin(annotation), get_args(annotation)
    if origin is tuple and key.isdigit():
        return inner[0] if inner[-1] is Ellipsis else inner[int(key)] if int(key) < len(inner) else None
    if origin in (Annotated, Union, types.UnionType):
        return next((found for item in inner if (found := _element(item, key)) is not None), None)
    return None
