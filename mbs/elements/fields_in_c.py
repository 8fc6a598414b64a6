"""Writes the C header of each force element: indices of its numbers, their checks, its sizes.

The classes are the source. After a change of theirs:

    python -m mbs.elements.fields_in_c
"""

import importlib
import textwrap
from collections.abc import Iterator
from pathlib import Path

import mbs.kernel
from mbs.common.checks import not_negative, number, positive
from mbs.elements.element import Element
from mbs.elements.integers import Integer, Of
from mbs.elements.reals import Check, Group, Real, declared, each_real, texts_of
from mbs.elements.record_checks import MOST, fraction, share
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


def class_of(kind: ElementType) -> type[Element]:
    """The class of a type of elements."""
    name = kind.name.lower()
    element_class = getattr(importlib.import_module(f"mbs.elements.{name}"), name.title().replace("_", ""))
    assert isinstance(element_class, type)
    assert issubclass(element_class, Element)
    return element_class


def texts(kind: type) -> dict[str, str]:
    """Docstrings below the fields of a class and of its base classes."""
    return {name: " ".join(text.split()) for c in reversed(kind.__mro__[:-1]) for name, text in texts_of(c).items()}


def header(kind: type[Element]) -> str:
    """The header of an element."""
    name = kind._type().name.lower()
    upper, words = name.upper(), kind._words
    required_reals, optional_reals = kind._numbers()
    required = sum(not of.optional for of in kind._integers)
    lines = [
        "/* clang-format off */",
        *_comment(f"Numbers of {words}. Written by `python -m mbs.elements.fields_in_c` from {kind.__name__}."),
        *_comment(f"Signals: {signals_of(kind)}."),
        *_comment("Outputs: " + ("; ".join(f"{o.name} ({o.unit}), {o.description}" for o in kind._outputs) or "none")),
        f"#ifndef ALI3_{upper}_FIELDS_H",
        f"#define ALI3_{upper}_FIELDS_H",
        '#include "element.h"',
        "",
        *_enumeration(kind, f"{upper}_REALS", len(required_reals), bool(optional_reals)),
    ]
    if kind._integers:
        lines += [
            "enum {",
            *(f"  {kind._prefix}{of.name.upper()}," for of in kind._integers),
            f"  {upper}_INTEGERS",
            "};",
        ]
    sizes = _sizes(kind, required)
    lines += ["#ifndef ALI3_WIDTH"]
    if required_reals or optional_reals:
        lines += [f"static const ali3_field {name}_fields[] = {{"]
        for _, real, called in each_real(kind):
            what, must = RANGES[real.check]
            lines += [f'  {{{what}, "{f"the {called} of {words} {must}" if must else ""}"}},']
        lines += ["};"]
        sizes |= {"fields": f"{name}_fields", "nfields": str(len(required_reals) + len(optional_reals))}
    if kind._integers:
        lines += [f"static const ali3_integer {name}_integers[] = {{"]
        for of in kind._integers:
            limits = f"{of.least}, {'INT32_MAX' if of.most == MOST else of.most}, {of.reals}, {of.states}"
            lines += [f'  {{{of.of.value}, {limits}, "{_sentence(of, words)}"}},']
        lines += ["};"]
        sizes |= {"integers": f"{name}_integers", "nintegers": f"{upper}_INTEGERS"}
    size_lines = textwrap.wrap(", ".join(f".{size}={value}" for size, value in sizes.items()), 90)
    size_lines = [line.replace("=", " = ") for line in size_lines]
    lines += [
        f"#define ALI3_{upper} \\",
        *(f"  {line} \\" for line in size_lines[:-1]),
        f"  {size_lines[-1]}",
        "#endif",
        "#endif",
    ]
    return "\n".join(lines) + "\n"


def _enumeration(kind: type[Element], size: str, own: int, more: bool) -> list[str]:
    """Places of the numbers; of those that may be missing as if nothing were counted before them."""
    meanings, lines, at, follows = texts(kind), ["enum {"], 0, ""
    for field, real in declared(kind).items():
        if more and at == own:
            lines += [f"  {size}{follows}", "};", "enum {"]
            follows = f" = {size}" + (f" + {kind._behind}" if kind._behind else "")
        name = kind._prefix + (real.name if isinstance(real, Real) and real.name else field).upper()
        lines += [*(f"  {line}" for line in _comment(meanings[field])), f"  {name}{follows},"]
        count = len([*each_real(real.kind)]) if isinstance(real, Group) else len(real.parts) or 1
        follows = f" = {name} + {count}" if count > 1 else ""
        if at < own < at + count:  # a group of which the last numbers may be missing
            follows, more = f" = {own}", False
        at += count
    if not at:
        return []
    return [*lines, *([] if more else [f"  {size}{follows}"]), "};"]


def signals_of(kind: type[Element]) -> str:
    """Names of the signals of an element, with their components."""
    if kind._signals is None:
        return "any number"
    return ", ".join(f"{s} ({' or '.join(map(str, n)) if isinstance(n, tuple) else n})" for s, n in kind._signals)


def _sizes(kind: type[Element], required: int) -> dict[str, str]:
    """Sizes in `ali3_element_type` that are not 0."""
    required_reals, optional_reals = kind._numbers()
    counts = [n if isinstance(n, tuple) else (n, n) for _, n in kind._signals or ()]
    space, plane = sum(n for n, _ in counts), sum(n for _, n in counts)
    sizes = {
        "nsig": -1 if kind._signals is None else space,
        "nsig_plane": 0 if plane == space else plane,
        "nreal": -1 if kind._behind is None else len(required_reals) + kind._behind,
        "nreal_more": len(optional_reals),
        "nint": required,
        "nstate": len(kind._states),
        "nstate_more": len(kind._more_states),
        "nout": len(kind._outputs),
    }
    return {size: str(n) for size, n in sizes.items() if n}


def _sentence(of: Integer, words: str) -> str:
    """Sentence of the kernel about an integer outside its range."""
    if of.of is not Of.NUMBERS:
        thing = "an input" if of.of is Of.INPUTS else "a road"
        return f"{of.called} of {words} names {thing} that does not exist"
    allowed = " or ".join(map(str, range(of.least, min(of.most, of.least + 3) + 1)))
    return f"{of.called} of {words} must be {allowed if of.most < of.least + 3 else f'at least {of.least}'}"


def _comment(text: str) -> list[str]:
    first, *following = textwrap.wrap(text, 112)
    lines = [f"/* {first}", *(f" * {line}" for line in following)]
    return [*lines[:-1], f"{lines[-1]} */"]


def headers() -> Iterator[tuple[Path, str]]:
    """The files in C, with their texts."""
    for kind in ElementType:
        yield FOLDER / f"{kind.name.lower()}_fields.h", header(class_of(kind))


def main() -> None:
    """Write the headers."""
    for file, text in headers():
        file.write_text(text, encoding="utf-8", newline="\n")


if __name__ == "__main__":
    main()
