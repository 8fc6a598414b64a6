"""Numbers of elements and roads: a field says its check in its type, and all else follows from its name.

    stiffness: NotNegative
    \"\"\"N/m.\"\"\"

`reals_of` then checks the values, and gives them with their names to the record, where a parameter finds them.
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
"""Checked numbers by name, in the order of the kernel, each with what a parameter may write there."""
Pair = tuple[float, float]


@dataclass(frozen=True)
class Real:
    """Check of a number of an element, given in the type of its field."""

    check: Check
    """Returns the number or raises one sentence."""
    parts: tuple[str, ...] = ()
    """Of several numbers in one field: the ends of their names."""
    words: str = ""
    """What a sentence calls it, where that is not its name."""
    name: str = ""
    """Its name, where that is not that of its field."""


@dataclass(frozen=True)
class Group:
    """Several numbers of one field, which a class of their own declares; it stands in the type of the field."""

    kind: type
    words: str
    """The class with its article, for sentences."""
    noun: str = ""
    """What sentences call it behind the name of its field."""
    optional: bool = False
    """Whether None is one without numbers."""
    apart: bool = False
    """Whether its numbers stand behind those of all fields, by their own names without that of the field."""

    def name(self, field: str, number: str) -> str:
        """Name of one number of the group in a field."""
        return number if self.apart else f"{field}_{number}"


Number = Annotated[float, Real(number)]
NotNegative = Annotated[float, Real(not_negative)]
Positive = Annotated[float, Real(positive)]
Share = Annotated[float, Real(share)]
Fraction = Annotated[float, Real(fraction)]


_DECLARED: dict[type, dict[str, Real | Group]] = {}


def declared(kind: type) -> dict[str, Real | Group]:
    """Numbers that a class declares and groups of them, by field, in the order of the kernel."""
    if kind not in _DECLARED:  # a car asks for those of its tyres many times
        hints = get_type_hints(kind, include_extras=True).items()
        annotations = ((name, real) for name, hint in hints for real in getattr(hint, "__metadata__", ()))
        numbers = {name: real for name, real in annotations if isinstance(real, (Real, Group))}
        apart = {name for name, real in numbers.items() if isinstance(real, Group) and real.apart}
        _DECLARED[kind] = {name: numbers[name] for name in sorted(numbers, key=apart.__contains__)}
    return _DECLARED[kind]


def each_real(kind: type) -> Iterator[tuple[str, Real, str]]:
    """Every single number that a class declares: its name, its declaration and what a sentence calls it."""
    for field, real in declared(kind).items():
        words = field.replace("_", " ")
        if isinstance(real, Group):
            noun = f"{words} {real.noun} ".strip() if real.noun else ""
            for name, member, called in each_real(real.kind):
                yield real.name(field, name), member, f"{called} of the {noun}" if noun else called
        else:
            base_name = real.name or field
            for name in [f"{base_name}_{suffix}" for suffix in real.parts] or [base_name]:
                yield name, real, real.words or base_name.replace("_", " ")


def texts_of(kind: type) -> dict[str, str]:
    """Docstrings below the fields of a class, by name."""
    (tree,) = ast.parse(textwrap.dedent(inspect.getsource(kind))).body
    assert isinstance(tree, ast.ClassDef)
    return {
        field.target.id: inspect.cleandoc(text.value.value)
        for field, text in pairwise(tree.body)
        if isinstance(field, ast.AnnAssign) and isinstance(field.target, ast.Name)
        if isinstance(text, ast.Expr) and isinstance(text.value, ast.Constant) and isinstance(text.value.value, str)
    }


def reals_of(thing: object, what: str, values: Mapping[str, object] | None = None) -> Reals:
    """Checked numbers of an element or a road, in the order of the kernel.

    `what`: the element, for messages; `values`: in place of fields, by name.
    """
    reals: Reals = {}
    for name, real in declared(type(thing)).items():
        value = values[name] if values and name in values else getattr(thing, name)
        if isinstance(real, Group):
            words = name.replace("_", " ")
            if not (value is None and real.optional):
                group: object = instance_of(real.kind, value, f"The {words} of {what}", real.words)
                numbers = reals_of(group, f"the {words} {real.noun} of {what}" if real.noun else what)
                reals |= {real.name(name, key): component for key, component in numbers.items()}
            continue
        base_name = real.name or name
        words = f"{real.words or base_name.replace('_', ' ')} of {what}"
        if not real.parts:
            reals[base_name] = (real.check(value, f"The {words}"), real.check)
            continue
        for suffix, component in zip(real.parts, vector(value, len(real.parts), f"the {words}"), strict=True):
            reals[f"{base_name}_{suffix}"] = (real.check(component, f"The {words}"), real.check)
    return reals
