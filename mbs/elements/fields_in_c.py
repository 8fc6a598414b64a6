"""Writes what elements declare into C: a header beside the law of each, with its numbers, their checks and its sizes.

The classes are the source. After a change of theirs:

    python -m mbs.elements.fields_in_c
"""

from __future__ import annotations

import importlib
import textwrap
from collections.abc import Iterator
from pathlib import Path

import mbs.kernel
from mbs.common.checks import not_negative, number, positive
from mbs.elements.element import Element
from mbs.elements.reals import Check, declared, texts_of
from mbs.elements.record_checks import fraction, share
from mbs.kernel.header.enumerations import ElementType

FOLDER = Path(mbs.kernel.__file__).parent / "src" / "elements"
RANGES: dict[Check, tuple[str, str]] = {
    number: ("ALI3_IS_ANY", ""),
    not_negative: ("ALI3_IS_NOT_NEGATIVE", "must not be negative"),
    positive: ("ALI3_IS_POSITIVE", "must be greater than zero"),
    share: ("ALI3_IS_SHARE", "must be above 0 and at most 1"),
    fraction: ("ALI3_IS_FRACTION", "must be at least 0 and below 1"),
}
"""Of a check: `ali3_range` in C, and what a number must be."""


def class_of(kind: ElementType) -> type:
    """The class of a type of elements."""
    name = kind.name.lower()
    found = getattr(importlib.import_module(f"mbs.elements.{name}"), name.title().replace("_", ""))
    assert isinstance(found, type)
    return found


def texts(kind: type) -> dict[str, str]:
    """What stands under each field of a class and of those that it comes from."""
    return {name: " ".join(text.split()) for c in reversed(kind.__mro__[:-1]) for name, text in texts_of(c).items()}


def header(kind: type[Element]) -> str:
    """The header of an element."""
    name = kind._type().name.lower()
    upper, reals, said = name.upper(), declared(kind), texts(kind)
    components = [n for _, n in kind._signals]
    sizes = {
        "nsig": str(sum(components)) if all(components) else "-1",
        "nreal": "-1" if kind._open else f"{upper}_REALS",
    }
    sizes |= {"nstate": str(len(kind._states)) if kind._states is not None else "-1", "nout": str(len(kind._outputs))}
    lines = [
        "/* clang-format off */",
        *_comment(f"Numbers of {kind._words}. Written by `python -m mbs.elements.fields_in_c` from {kind.__name__}."),
        *_comment("Signals: " + ", ".join(f"{s} ({n or '2 or 3'})" for s, n in kind._signals) + "."),
        *_comment("Outputs: " + ("; ".join(f"{o.name} ({o.unit}), {o.description}" for o in kind._outputs) or "none")),
        f"#ifndef ALI3_{upper}_FIELDS_H",
        f"#define ALI3_{upper}_FIELDS_H",
        '#include "element.h"',
        "",
        "enum {",
    ]
    for field in reals:
        lines += [*(f"  {line}" for line in _comment(said[field])), f"  {field.upper()},"]
    lines += [f"  {upper}_REALS", "};", "#ifndef ALI3_WIDTH"]
    lines += [f"static const ali3_field {name}_fields[{upper}_REALS] = {{"]
    for field, real in reals.items():
        what, must = RANGES[real.check]
        sentence = f"the {real.words or field.replace('_', ' ')} of {kind._words} {must}" if must else ""
        lines += [f'  {{{what}, "{sentence}"}},']
    lines += ["};", f"#define ALI3_{upper} .fields = {name}_fields, .nfields = {upper}_REALS, \\"]
    lines += ["  " + ", ".join(f".{size} = {value}" for size, value in sizes.items()), "#endif", "#endif"]
    return "\n".join(lines) + "\n"


def _comment(text: str) -> list[str]:
    first, *others = textwrap.wrap(text, 112)
    lines = [f"/* {first}", *(f" * {line}" for line in others)]
    return [*lines[:-1], f"{lines[-1]} */"]


def headers() -> Iterator[tuple[Path, str]]:
    """The files in C, with their texts."""
    for kind in ElementType:
        declaring = class_of(kind)
        if issubclass(declaring, Element):
            yield FOLDER / f"{kind.name.lower()}_fields.h", header(declaring)


def main() -> None:
    """Write the headers."""
    for file, text in headers():
        file.write_text(text, encoding="utf-8", newline="\n")


if __name__ == "__main__":
    main()
