"""Tables of force elements for the documentation, from their classes and docstrings."""

import dataclasses
import inspect
from collections.abc import Iterable, Iterator

from mbs.elements.fields_in_c import RANGES, class_of, signals_of, texts
from mbs.elements.reals import Group, Real, declared
from mbs.kernel.header.enumerations import ElementType


def element_table() -> str:
    """Table of signals, integers, states and outputs of each element type, for the page of the System file."""
    rows = []
    for kind in ElementType:
        element_class = class_of(kind)
        states = f"{len(element_class._states)}" + (
            f", {len(element_class._states) + len(element_class._optional_states)}"
            if element_class._optional_states
            else ""
        )
        integers = ", ".join(f"`{i.name}`" + " or none" * i.optional for i in element_class._integers)
        outputs = "; ".join(f"`{o.name}` ({o.unit})" for o in element_class._outputs)
        rows += [(f"{kind.value}", kind.name, signals_of(element_class), integers, states, outputs)]
    return _table(("type", "name", "signals", "integers", "states", "outputs"), rows)


def number_table() -> str:
    """Table of range, default, meaning and unit of each real of each element type, in the order of the kernel."""
    rows = []
    for kind in ElementType:
        name = f"`{kind.name}`"
        for names, range_text, default, text in _numbers(class_of(kind)):
            rows += [(name, ", ".join(f"`{n}`" for n in names), range_text, default, text)]
            name = ""
    return _table(("element", "number", "range", "default", "meaning, unit"), rows)


def law_table() -> str:
    """Table of law and C file of each element type, for the page of force laws."""
    rows = []
    for kind in ElementType:
        element_class = class_of(kind)
        law = " ".join(inspect.cleandoc(element_class.__doc__ or "").split())
        rows += [(f"`{element_class.__name__}`", law, f"`mbs/kernel/src/elements/{kind.name.lower()}.c`")]
    return _table(("element", "law", "file"), rows)


def _numbers(kind: type, group: Group | None = None, field: str = "") -> Iterator[tuple[list[str], str, str, str]]:
    """Names, range, default and docstring of each field; a group names its numbers."""
    descriptions = texts(kind)
    defaults = {f.name: f.default for f in dataclasses.fields(kind)} if dataclasses.is_dataclass(kind) else {}
    for name, real in declared(kind).items():
        if isinstance(real, Group):
            yield from _numbers(real.kind, real, name)
            continue
        base_name = real.name or name
        names = [f"{base_name}_{suffix}" for suffix in real.parts] or [base_name]
        group_names = [group.name(field, n) for n in names] if group else names
        yield group_names, _range(real), _default_text(defaults.get(name, dataclasses.MISSING)), descriptions[name]


def _range(real: Real) -> str:
    """Range of a number in words; empty for any number."""
    return RANGES[real.check][1].replace("must not be", "not").removeprefix("must be ")


def _default_text(default: object) -> str:
    if default is dataclasses.MISSING or default is None:
        return ""
    numbers = default if isinstance(default, tuple) else (default,)
    return ", ".join(f"{value:.6g}" if isinstance(value, float) else str(value) for value in numbers)


def _table(head: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    head = (*head,)
    lines = [head, ("---",) * len(head), *([cell.replace("|", "\\|") for cell in row] for row in rows)]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines)
