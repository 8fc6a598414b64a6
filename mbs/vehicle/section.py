"""A table of a car file as a typed object."""

import sys
from collections.abc import Iterator
from inspect import signature
from typing import Any, TypeVar, get_args

from pydantic import BaseModel, ConfigDict, Field, PrivateAttr
from pydantic.fields import FieldInfo

from mbs.elements.reals import texts_of
from mbs.vehicle.quantities import Quantity, quantities_in

Element = TypeVar("Element")

AXES, PRODUCTS = ("x", "y", "z"), ("xy", "xz", "yz")
"""Names of the numbers of a point or of moments of inertia, and of products of inertia."""


class Section(BaseModel):
    """Base of all tables of a car file: no other keys than its own, and it cannot be changed.

    The strings under the attributes are the descriptions of the file's reference and of the FMU's parameters. An
    attribute without one has the text of the same name in the element `of`, without its unit.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, use_attribute_docstrings=True, allow_inf_nan=False)

    _path: str = PrivateAttr("")

    def __init_subclass__(cls, of: type | None = None, **options: Any) -> None:
        super().__init_subclass__(**options)
        texts, namespace = {} if of is None else texts_of(of), vars(sys.modules[cls.__module__])
        for name in texts.keys() & cls.__annotations__.keys():
            field = cls.__dict__.get(name, ...)
            if not isinstance(field, FieldInfo):  # else the field has its own text
                annotation = cls.__annotations__[name]
                if isinstance(annotation, str):  # in a module with deferred annotations
                    annotation = eval(annotation, namespace)
                text = _without_unit(" ".join(texts[name].split()), annotation)
                setattr(cls, name, Field(field, description=text))

    def element(self, kind: type[Element], **more: Any) -> Element:
        """Make an element with the numbers of this table in its fields of the same names.

        `kind`: class of the element; `more`: further fields, which override fields of the table.
        """
        fields = {name: getattr(self, name) for name in signature(kind).parameters if name in type(self).model_fields}
        return kind(**(fields | more))

    @property
    def path(self) -> str:
        """Key path of the section in the file, such as "front.spring"; "" for the whole file."""
        return self._path

    def key(self, field: str) -> str:
        """Key path of a field."""
        return f"{self._path}.{field}" if self._path else field

    def faults(self) -> Iterator[str]:
        """Yield a sentence for each contradiction between the numbers of this table."""
        yield from ()

    def oddities(self) -> Iterator[str]:
        """Yield a sentence for each unusual property of this table."""
        yield from ()

    @classmethod
    def quantity(cls, field: str) -> Quantity | None:
        """Unit and range of a field, None if it is not a single number."""
        info = cls.model_fields[field]
        for metadata in (info.metadata, *(getattr(a, "__metadata__", ()) for a in get_args(info.annotation))):
            for item in metadata:
                if isinstance(item, Quantity):
                    return item
        return None

    def numbers(self, field: str) -> dict[str, float]:
        """Numbers of a field by the names of parameters; the numbers of a list end with the name of the component.

        `field`: field with a quantity and a value that is not None.
        """
        value, path = getattr(self, field), self.key(field)
        if not isinstance(value, tuple):
            return {path: float(value)}
        components = PRODUCTS if field == "products" else AXES
        return {f"{path}.{component}": float(number) for component, number in zip(components, value, strict=True)}

    def locate(self, path: str) -> None:
        """Set the key paths of this section and of those in it.

        `path`: key path of this section.
        """
        self._path = path
        for name in type(self).model_fields:
            for key, value in _sections(name, getattr(self, name)):
                value.locate(self.key(key))


def _without_unit(text: str, annotation: Any) -> str:
    """Text of a field without its unit, which is part of the quantity."""
    units = {q.unit.replace(".", " ") for q in quantities_in(annotation)} - {"1"}
    assert all(f", {unit}" in text for unit in units), f"{text!r} must say its unit, {units}"
    for unit in units or {"a ratio"}:
        text = text.replace(f", {unit}", "", 1)
    return text


def sections_of(section: Section) -> Iterator[Section]:
    """Yield a section and all sections in it, in the order of their types."""
    yield section
    for name in type(section).model_fields:
        for _, inner in _sections(name, getattr(section, name)):
            yield from sections_of(inner)


def _sections(name: str, value: Any) -> list[tuple[str, Section]]:
    """Sections in the value of a field, with their keys."""
    if isinstance(value, Section):
        return [(name, value)]
    if isinstance(value, dict):
        return [(f"{name}.{key}", v) for key, v in value.items() if isinstance(v, Section)]
    if isinstance(value, (list, tuple)):
        return [(f"{name}.{k}", v) for k, v in enumerate(value) if isinstance(v, Section)]
    return []
