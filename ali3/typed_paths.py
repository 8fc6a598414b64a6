"""Finds the type and limits of the value at a key path in the types of a file."""

import types
from collections.abc import Iterator, Mapping, Sequence
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from annotated_types import Ge, Gt, Le, Lt
from pydantic import BaseModel
from pydantic.fields import FieldInfo

Table = type[BaseModel]
NOTHING = type(None)


def keys_of(table: Table) -> dict[str, FieldInfo]:
    """Fields of a table by their keys in the file."""
    return {field.alias or name: field for name, field in table.model_fields.items()}


def annotation_of(field: FieldInfo) -> Any:
    """Type of a field with its annotations."""
    metadata = [*field.metadata, *([field] if field.title else [])]
    return Annotated[(field.annotation, *metadata)] if metadata else field.annotation


def templates(annotation: Any) -> list[Table]:
    """Possible tables of a type; several if `kind` chooses a template."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    if get_origin(annotation) in (Annotated, Union, types.UnionType):
        return [t for inner in get_args(annotation) for t in templates(inner)]
    return []


def value_type_of(annotation: Any) -> Any | None:
    """Type of the values of a table whose keys the user chooses; None for any other type."""
    type_arguments = _dict_of(annotation)
    return None if type_arguments is None else type_arguments[1]


def key_type_of(annotation: Any) -> Any:
    """Type of the keys of a table whose keys the user chooses; text for any other type."""
    type_arguments = _dict_of(annotation)
    return str if type_arguments is None else type_arguments[0]


def _dict_of(annotation: Any) -> tuple[Any, ...] | None:
    if get_origin(annotation) is dict:
        return get_args(annotation)
    if get_origin(annotation) in (Annotated, Union, types.UnionType):
        return next((result for inner in get_args(annotation) if (result := _dict_of(inner)) is not None), None)
    return None


def kinds_of(table: Table) -> tuple[str, ...]:
    """Values of `kind` that choose a template; empty without that key."""
    return get_args(table.model_fields["kind"].annotation) if "kind" in table.model_fields else ()


def annotation_at(top: Any, path: Sequence[str], data: Any) -> Any | None:
    """Type of the value at a key path; None if there is no such key.

    `top`: the whole file: a model, or several of which the key ``kind`` chooses one; `path`: keys from the top; `data`:
    content of the file, which determines the kinds of templates.
    """
    annotation: Any = top
    for key in path:
        inner = value_type_of(annotation)
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
            annotation = _element_type(annotation, key)
            if annotation is None:
                return None
        data = item_of(data, key)
    return annotation


def chosen(annotation: Any, data: Any) -> Table | None:
    """The table of a type that the key `kind` of the data chooses."""
    tables = templates(annotation)
    if len(tables) == 1:
        return tables[0]
    kind = data.get("kind") if isinstance(data, Mapping) else None
    return next((table for table in tables if kind in kinds_of(table)), None)


def table_at(top: Any, path: Sequence[str], data: Any) -> Table | None:
    """Table at a key path; None if there is none.

    `top`: the whole file: a model, or several of which the key ``kind`` chooses one; `path`: keys from the top; `data`:
    content of the file, which determines the kinds of templates.
    """
    node = data
    for key in path:
        node = item_of(node, key)
    return chosen(annotation_at(top, path, data), node)


def all_keys(table: Table, path: str = "") -> Iterator[str]:
    """Key paths of a table and of the tables in it, for all templates. `path`: keys to the table."""
    for key, field in keys_of(table).items():
        key_path = f"{path}.{key}" if path else key
        yield key_path
        inner = value_type_of(field.annotation)
        value_type = field.annotation if inner is None else inner
        for template in templates(_element_type(value_type, "0") or value_type):
            yield from all_keys(template, key_path if inner is None else f"{key_path}.NAME")


def title_of(annotation: Any) -> str:
    """Description of the allowed values in the title of a field; empty without one."""
    return next((f.title for f in _metadata(annotation) if isinstance(f, FieldInfo) and f.title), "")


def holds_keys(top: Any, path: Sequence[str], data: Any) -> bool:
    """Whether the type at a key path is a table, including tables with keys of the user."""
    annotation = annotation_at(top, path, data)
    return bool(templates(annotation)) or value_type_of(annotation) is not None


def words(annotation: Any) -> str:
    """Description of the values of a type."""
    title = title_of(annotation)
    if title:
        return title
    if templates(annotation) or value_type_of(annotation) is not None:
        return "a table"
    range_text = next((item.range for item in _metadata(annotation) if hasattr(item, "range")), None)
    if range_text is not None:  # a physical quantity
        return f"a number, {range_text}"
    origin, inner = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        limits = [item for item in inner[1:] if not isinstance(item, FieldInfo)]
        limits += [m for item in inner[1:] if isinstance(item, FieldInfo) for m in item.metadata]
        return words(inner[0]) + _limit_text(limits)
    if origin in (Union, types.UnionType):
        redundant_types = {int} if float in inner else set()  # a whole number is a number
        return " or ".join(
            dict.fromkeys(words(item) for item in inner if item is not NOTHING and item not in redundant_types)
        )
    if origin is Literal:
        return " or ".join(map(repr, inner))
    if origin in (tuple, list):
        return _list_text((*inner, Ellipsis) if origin is list else inner)
    return {str: "text", int: "a whole number", float: "a number", bool: "true or false"}.get(annotation, "a value")


def _limit_text(limits: Sequence[Any]) -> str:
    """Limits of a number, with a blank before them."""
    words_of = {"ge": "from", "gt": "above", "le": "up to", "lt": "below"}
    ends = {name: getattr(item, name) for item in limits for name in words_of if isinstance(item, Ge | Gt | Le | Lt)
            and hasattr(item, name)}  # fmt: skip
    limit_texts = {name: f"{end:.12g}" if isinstance(end, float) else str(end) for name, end in ends.items()}
    if limit_texts.keys() == {"ge", "le"}:
        return f" from {limit_texts['ge']} to {limit_texts['le']}"
    return "".join(f" {word} {limit_texts[name]}" for name, word in words_of.items() if name in limit_texts)


def _list_text(inner: tuple[Any, ...]) -> str:
    if inner[-1] is not Ellipsis and any(item != inner[0] for item in inner):
        return f"a list of {' and '.join(words(item) for item in inner)}"
    element_text = words(inner[0])
    noun, _, elements_text = element_text.partition(" of ")
    plural = {"a list": "lists", "text": "texts", "a table": "tables"}.get(noun, noun.replace("a number", "numbers"))
    plural += f" of {elements_text}" if elements_text else ""
    if inner[-1] is Ellipsis:
        return f"a list of {plural}"
    return f"a list of {len(inner)} {plural}"


def _metadata(annotation: Any) -> tuple[Any, ...]:
    return getattr(annotation, "__metadata__", ())


def item_of(data: Any, key: str) -> Any:
    """The item at a key of a table or an index, from 0, of a list; None without one."""
    if isinstance(data, Mapping):
        return data.get(key)
    if isinstance(data, (list, tuple)) and key.isdigit() and int(key) < len(data):
        return data[int(key)]
    return None


def _element_type(annotation: Any, key: str) -> Any | None:
    """Type of an element of a list."""
    origin, inner = get_origin(annotation), get_args(annotation)
    if origin is list and key.isdigit():
        return inner[0]
    if origin is tuple and key.isdigit():
        return inner[0] if inner[-1] is Ellipsis else inner[int(key)] if int(key) < len(inner) else None
    if origin in (Annotated, Union, types.UnionType):
        return next((result for item in inner if (result := _element_type(item, key)) is not None), None)
    return None
