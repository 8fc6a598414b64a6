"""Tables of force elements for the documents, made from their classes and the laws in their docstrings."""

import dataclasses
import inspect
from collections.abc import Iterable, Iterator

from mbs.elements.fields_in_c import RANGES, class_of, signals_of, texts
from mbs.elements.reals import Group, Real, declared
from mbs.kernel.header.enumerations import ElementType


def element_table() -> str:
    """Table of the page of the System file: signals, integers, states and outputs of each element type."""
    rows = []
    for kind in ElementType:
        of = class_of(kind)
        states = f"{len(of._states)}" + (f", {len(of._states) + len(of._more_states)}" if of._more_states else "")
        integers = ", ".join(f"`{i.name}`" + " or none" * i.optional for i in of._integers)
        outputs = "; ".join(f"`{o.name}` ({o.unit})" for o in of._outputs)
        rows += [(f"{kind.value}", kind.name, signals_of(of), integers, states, outputs)]
    return _table(("type", "name", "signals", "integers", "states", "outputs"), rows)


def number_table() -> str:
    """Range, default, meaning and unit of each number of each element type, in the order of its reals."""
    rows = []
    for kind in ElementType:
        name = f"`{kind.name}`"
        for names, checked, default, text in _numbers(class_of(kind)):
            rows += [(name, ", ".join(f"`{n}`" for n in names), checked, default, text)]
            name = ""
    return _table(("element", "number", "range", "default", "meaning, unit"), rows)


def law_table() -> str:
    """Table of the page of the theory: law and C file of each element type."""
    rows = []
    for kind in ElementType:
        of = class_of(kind)
        law = " ".join(inspect.cleandoc(of.__doc__ or "").split())
        rows += [(f"`{of.__name__}`", law, f"`mbs/kernel/src/elements/{kind.name.lower()}.c`")]
    return _table(("element", "law", "file"), rows)


def _numbers(kind: type, group: Group | None = None, field: str = "") -> Iterator[tuple[list[str], str, str, str]]:
    """Names, range, default and text of each field; fields of a group have the names that the group gives them."""
    descriptions = texts(kind)
    defaults = {f.name: f.default for f in dataclasses.fields(kind)} if dataclasses.is_dataclass(kind) else {}
    for name, real in declared(kind).items():
        if isinstance(real, Group):
            yield from _numbers(real.kind, real, name)
            continue
        base_name = real.name or name
        names = [f"{base_name}_{part}" for part in real.parts] or [base_name]
        named = [group.name(field, n) for n in names] if group else names
        yield named, _range(real), _shown(defaults.get(name, dataclasses.MISSING)), descriptions[name]


def _range(real: Real) -> str:
    """Range of a number in words; empty: any."""
    return RANGES[real.check][1].replace("must not be", "not").removeprefix("must be ")


def _shown(default: object) -> str:
    if default is dataclasses.MISSING or default is None:
        return ""
    numbers = default if isinstance(default, tuple) else (default,)
    return ", ".join(f"{value:.6g}" if isinstance(value, float) else str(value) for value in numbers)


def _table(head: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    head = (*head,)
    lines = [head, ("---",) * len(head), *([cell.replace("|", "\\|") for cell in row] for row in rows)]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines)
