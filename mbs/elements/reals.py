"""Numbers of elements and roads: a field says its check in its type, and all else follows from its name.

    stiffness: NotNegative
    \"\"\"N/m.\"\"\"

`reals_of` then checks the values, and gives them with their names to the record, where a parameter finds them.
"""

from __future__ import annotations

import ast
import inspect
import textwrap
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated, TypeAlias, get_type_hints

from mbs.common.checks import not_negative, number, positive, vector
from mbs.elements.record_checks import fraction, share

Check: TypeAlias = Callable[[object, str], float]
"""One of the checks of numbers of `mbs.common.checks`."""
Reals: TypeAlias = dict[str, tuple[float, Check]]
"""Checked numbers by name, in the order of the kernel, each with what a parameter may write there."""
Pair = tuple[float, float]


@dataclass(frozen=True)
class Real:
    """What a number of an element must satisfy; it stands in the type of its field."""

    check: Check
    """Returns the number or raises one sentence."""
    parts: tuple[str, ...] = ()
    """Of several numbers in one field: the ends of their names."""
    words: str = ""
    """What a sentence calls it, where that is not its name."""


Number = Annotated[float, Real(number)]
NotNegative = Annotated[float, Real(not_negative)]
Positive = Annotated[float, Real(positive)]
Share = Annotated[float, Real(share)]
Fraction = Annotated[float, Real(fraction)]


_DECLARED: dict[type, dict[str, Real]] = {}


def declared(kind: type) -> dict[str, Real]:
    """Numbers that a class declares, by name."""
    if kind not in _DECLARED:  # a car asks for those of its tyres many times
        hints = get_type_hints(kind, include_extras=True).items()
        found = ((name, real) for name, hint in hints for real in getattr(hint, "__metadata__", ()))
        _DECLARED[kind] = {name: real for name, real in found if isinstance(real, Real)}
    return _DECLARED[kind]


def texts_of(kind: type) -> dict[str, str]:
    """What stands under each field of a class, by name."""
    (tree,) = ast.parse(textwrap.dedent(inspect.getsource(kind))).body
    assert isinstance(tree, ast.ClassDef)
    return {
        field.target.id: inspect.cleandoc(text.value.value)
        for field, text in pairwise(tree.body)
        if isinstance(field, ast.AnnAssign) and isinstance(field.target, ast.Name)
        if isinstance(text, ast.Expr) and isinstance(text.value, ast.Constant) and isinstance(text.value.value, str)
    }


def reals_of(thing: object, what: str, names: Sequence[str] = ()) -> Reals:
    """Checked numbers of an element or a road.

    `what`: the thing, for the message; `names`: which, in the order of the kernel; by default all in the order of the
    fields.
    """
    known = declared(type(thing))
    reals: Reals = {}
    for name in names or known:
        real, value = known[name], getattr(thing, name)
        words = f"{real.words or name.replace('_', ' ')} of {what}"
        if not real.parts:
            reals[name] = (real.check(value, f"The {words}"), real.check)
            continue
        for part, one in zip(real.parts, vector(value, len(real.parts), f"the {words}"), strict=True):
            reals[f"{name}_{part}"] = (real.check(one, f"The {words}"), real.check)
    return reals
