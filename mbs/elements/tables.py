"""Tables of force elements for the pages: what their classes declare, and their laws, which their docstrings say."""

import dataclasses
import inspect
from collections.abc import Iterable, Iterator

from mbs.elements.fields_in_c import RANGES, class_of, signals_of, texts
from mbs.elements.reals import Group, Real, declared
from mbs.kernel.header.enumerations import ElementType


def element_table() -> str:
    """A row a type: its signals, integers, states and outputs, as the page of the System file shows them."""
    rows = []
    for kind in ElementType:
        of = class_of(kind)
        states = f"{len(of._states)}" + (f", {len(of._states) + len(of._more_states)}" if of._more_states else "")
        integers = ", ".join(f"`{i.name}`" + " or none" * i.optional for i in of._integers)
        outputs = "; ".join(f"`{o.name}` ({o.unit})" for o in of._outputs)
        rows += [(f"{kind.value}", kind.name, signals_of(of), integers, states, outputs)]
    return _table(("type", "name", "signals", "integers", "states", "outputs"), rows)


def number_table() -> str:
    """A row a field of each type, in the order of the reals: names, range, default, meaning and unit."""
    rows = []
    for kind in ElementType:
        name = f"`{kind.name}`"
        for names, checked, default, text in _numbers(class_of(kind)):
            rows += [(name, ", ".join(f"`{n}`" for n in names), checked, default, text)]
            name = ""
    return _table(("element", "number", "range", "default", "meaning, unit"), rows)


def law_table() -> str:
    """A row a type: its law and the file in C, as the page of the theory shows them."""
    rows = []
    for kind in ElementType:
        of = class_of(kind)
        law = " ".join(inspect.cleandoc(of.__doc__ or "").split())
        rows += [(f"`{of.__name__}`", law, f"`mbs/kernel/src/elements/{kind.name.lower()}.c`")]
    return _table(("element", "law", "file"), rows)


def _numbers(kind: type, group: Group | None = None, field: str = "") -> Iterator[tuple[list[str], str, str, str]]:
    """Names of each field, its range, default and text; those of a group by the names that it gives them."""
    said = texts(kind)
    defaults = {f.name: f.default for f in dataclasses.fields(kind)} if dataclasses.is_dataclass(kind) else {}
    for name, real in declared(kind).items():
        if isinstance(real, Group):
            yield from _numbers(real.kind, real, name)
            continue
        own = real.name or name
        names = [f"{own}_{part}" for part in real.parts] or [own]
        named = [group.name(field, n) for n in names] if group else names
        yield named, _range(real), _shown(defaults.get(name, dataclasses.MISSING)), said[name]


def _range(real: Real) -> str:
    """What a number must be; nothing where it may be any."""
    return RANGES[real.check][1].replace("must not be", "not").removeprefix("must be ")


def _shown(default: object) -> str:
    if default is dataclasses.MISSING or default is None:
        return ""
    parts = default if isinstance(default, tuple) else (default,)
    return ", ".join(f"{part:.6g}" if isinstance(part, float) else str(part) for part in parts)


def _table(head: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    lines = [*rows]
    head = (*head,)
    return "\n".join(
        f"| {' | '.join(cells)} |"
        for cells in (head, ("---",) * len(head), *([c.replace("|", "\\|") for c in line] for line in lines))
    )
