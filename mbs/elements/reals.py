"""Reals of elements and roads: fields whose type has the check, as in

    stiffness: NotNegative
    \"\"\"N/m.\"\"\"

`reals_of` checks the values and returns them by name for the record, where parameters find them.
"""

import ast
import inspect
import textwrap
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated, TypeAlias, get_type_hints

from mbs.common.checks import instance_of, not_negative, number, positive, vector
from mbs.elements.record_checks import fraction, share

Check: TypeAlias = Callable[[object, str], float]
"""One of the checks of numbers of `mbs.common.checks`."""
Reals: TypeAlias = dict[str, tuple[float, Check]]
"""Checked numbers by name, in the order of the kernel, each with the check of parameter values."""
Pair = tuple[float, float]


@dataclass(frozen=True)
class Real:
    """Check of a number of an element, as an annotation of its field."""

    check: Check
    """Returns the number or raises `ModelError`."""
    parts: tuple[str, ...] = ()
    """Suffixes of the names of several numbers in one field."""
    noun: str = ""
    """Noun for messages, if that is not the name."""
    name: str = ""
    """Name, if that is not the name of the field."""
    meaning: str = ""
    """Meaning in the header of the law, if the field may also be something other than a number."""


@dataclass(frozen=True)
class Group:
    """Numbers of one field that a class declares, as an annotation of the field."""

    kind: type
    class_phrase: str
    """Class with its article, for messages."""
    noun: str = ""
    """Noun for messages after the name of the field."""
    optional: bool = False
    """Whether the field may be None, which has no numbers."""
    separate: bool = False
    """Whether its numbers follow the numbers of all fields, under their own names without the name of the field."""

    def name(self, field: str, number: str) -> str:
        """Name of one number of the group in a field."""
        return number if self.separate else f"{field}_{number}"


Number = Annotated[float, Real(number)]
NotNegative = Annotated[float, Real(not_negative)]
Positive = Annotated[float, Real(positive)]
Share = Annotated[float, Real(share)]
Fraction = Annotated[float, Real(fraction)]


_DECLARED: dict[type, dict[str, Real | Group]] = {}


def declared(kind: type) -> dict[str, Real | Group]:
    """Numbers and groups of numbers that a class declares, by field, in the order of the kernel."""
    if kind not in _DECLARED:  # type hints take long to evaluate
        hints = get_type_hints(kind, include_extras=True).items()
        annotations = ((name, real) for name, hint in hints for real in getattr(hint, "__metadata__", ()))
        numbers = {name: real for name, real in annotations if isinstance(real, (Real, Group))}
        separate = {name for name, real in numbers.items() if isinstance(real, Group) and real.separate}
        _DECLARED[kind] = {name: numbers[name] for name in sorted(numbers, key=separate.__contains__)}
    return _DECLARED[kind]


def each_real(kind: type) -> Iterator[tuple[str, Real, str]]:
    """Name, declaration and noun of every single number that a class declares."""
    for field, real in declared(kind).items():
        if isinstance(real, Group):
            group_noun = f"{field.replace('_', ' ')} {real.noun} ".strip() if real.noun else ""
            for name, member, noun in each_real(real.kind):
                yield real.name(field, name), member, f"{noun} of the {group_noun}" if group_noun else noun
        else:
            base_name = real.name or field
            for name in [f"{base_name}_{suffix}" for suffix in real.parts] or [base_name]:
                yield name, real, real.noun or base_name.replace("_", " ")


def texts_of(kind: type) -> dict[str, str]:
    """Docstrings of the fields of a class, by field."""
    (tree,) = ast.parse(textwrap.dedent(inspect.getsource(kind))).body
    assert isinstance(tree, ast.ClassDef)
    return {
        field.target.id: inspect.cleandoc(text.value.value)
        for field, text in pairwise(tree.body)
        if isinstance(field, ast.AnnAssign) and isinstance(field.target, ast.Name)
        if isinstance(text, ast.Expr) and isinstance(text.value, ast.Constant) and isinstance(text.value.value, str)
    }


def reals_of(owner: object, label: str, values: Mapping[str, object] | None = None) -> Reals:
    """Checked numbers of an element or a road, in the order of the kernel.

    `label`: label of the element or road, for messages; `values`: values by name that replace fields.
    """
    reals: Reals = {}
    for name, real in declared(type(owner)).items():
        value = values[name] if values and name in values else getattr(owner, name)
        if isinstance(real, Group):
            field_noun = name.replace("_", " ")
            if not (value is None and real.optional):
                group: object = instance_of(real.kind, value, f"The {field_noun} of {label}", real.class_phrase)
                numbers = reals_of(group, f"the {field_noun} {real.noun} of {label}" if real.noun else label)
                reals |= {real.name(name, key): component for key, component in numbers.items()}
            continue
        base_name = real.name or name
        noun = f"{real.noun or base_name.replace('_', ' ')} of {label}"
        if not real.parts:
            reals[base_name] = (real.check(value, f"The {noun}"), real.check)
            continue
        for suffix, component in zip(real.parts, vector(value, len(real.parts), f"the {noun}"), strict=True):
            reals[f"{base_name}_{suffix}"] = (real.check(component, f"The {noun}"), real.check)
    return reals
