"""C headers of the force elements: indices of their numbers and outputs, checks and sizes.

They are written from the classes, after each change of one, by

    python -m mbs.elements.fields_in_c
"""

import importlib
import textwrap
from collections.abc import Iterator
from itertools import chain
from pathlib import Path

import mbs.kernel
from mbs.common.checks import capital, not_negative, number, positive
from mbs.elements.element import Element
from mbs.elements.integers import Integer, IntegerKind
from mbs.elements.reals import Check, Group, Real, declared, each_real, texts_of
from mbs.elements.record_checks import INT32_MAX, fraction, share
from mbs.kernel.header.enumerations import ElementType

FOLDER = Path(mbs.kernel.__file__).parent / "src" / "elements"
RANGES: dict[Check, tuple[str, str]] = {
    number: ("ALI3_IS_ANY", ""),
    not_negative: ("ALI3_IS_NOT_NEGATIVE", "must not be negative"),
    positive: ("ALI3_IS_POSITIVE", "must be greater than zero"),
    share: ("ALI3_IS_SHARE", "must be above 0 and at most 1"),
    fraction: ("ALI3_IS_FRACTION", "must be at least 0 and below 1"),
}
"""`ali3_range` in C of each check, and the requirement in messages."""


def class_of(kind: ElementType) -> type[Element]:
    """Class of an element type."""
    name = kind.name.lower()
    element_class = getattr(importlib.import_module(f"mbs.elements.{name}"), name.title().replace("_", ""))
    assert isinstance(element_class, type)
    assert issubclass(element_class, Element)
    return element_class


def texts(kind: type) -> dict[str, str]:
    """Docstrings of the fields of a class and of its base classes, by field."""
    return {name: " ".join(text.split()) for c in reversed(kind.__mro__[:-1]) for name, text in texts_of(c).items()}


def header(kind: type[Element]) -> str:
    """Text of the header of an element class."""
    name = kind._type().name.lower()
    upper, noun = name.upper(), kind._noun
    required_reals, optional_reals = kind._real_names()
    required = sum(not integer.optional for integer in kind._integers)
    lines = [
        "/* clang-format off */",
        *_comment(f"Numbers of {noun}. Written by `python -m mbs.elements.fields_in_c` from {kind.__name__}."),
        *_comment(f"Signals: {signals_of(kind)}."),
        f"#ifndef ALI3_{upper}_FIELDS_H",
        f"#define ALI3_{upper}_FIELDS_H",
        '#include "element.h"',
        "",
        *_enumeration(kind, f"{upper}_REALS", len(required_reals), bool(optional_reals)),
    ]
    lines += _integer_and_output_numbers(kind, upper)
    sizes = _sizes(kind, required)
    lines += ["#ifndef ALI3_WIDTH"]
    if required_reals or optional_reals:
        lines += _real_table(kind, name)
        sizes |= {"fields": f"{name}_fields", "nfields": str(len(required_reals) + len(optional_reals))}
    if kind._integers:
        lines += _integer_table(kind, name)
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


def _integer_and_output_numbers(kind: type[Element], upper: str) -> list[str]:
    """Enumerations of the integers and of the outputs. `upper`: name of the element in capital letters."""
    lines: list[str] = []
    if kind._integers:
        lines += [
            "enum {",
            *chain.from_iterable(_entry(kind._c_prefix + i.name.upper(), i.meaning) for i in kind._integers),
            f"  {upper}_INTEGERS",
            "};",
        ]
    if kind._outputs:
        lines += ["enum {"]
        for output in kind._outputs:
            meaning = capital(output.description) + ("." if output.unit == "1" else f", {output.unit}.")
            lines += _entry(f"{upper}_OUT_{output.name.upper()}", meaning)
        lines += [f"  {upper}_OUTPUTS", "};"]
    return lines


def _real_table(kind: type[Element], name: str) -> list[str]:
    """Table of the ranges of the reals, with the sentence about a value outside."""
    lines = [f"static const ali3_field {name}_fields[] = {{"]
    for _, real, real_noun in each_real(kind):
        range_name, requirement = RANGES[real.check]
        lines += [f'  {{{range_name}, "{f"the {real_noun} of {kind._noun} {requirement}" if requirement else ""}"}},']
    lines += ["};"]
    return lines


def _integer_table(kind: type[Element], name: str) -> list[str]:
    """Table of what the integers index, their limits, and the sentence about a wrong one."""
    lines = [f"static const ali3_integer {name}_integers[] = {{"]
    for integer in kind._integers:
        most = "INT32_MAX" if integer.most == INT32_MAX else integer.most
        limits = f"{integer.least}, {most}, {len(integer.numbers)}, {len(integer.states)}"
        lines += [f'  {{{integer.kind.value}, {limits}, "{_sentence(integer, kind._noun)}"}},']
    lines += ["};"]
    return lines


def _enumeration(kind: type[Element], size: str, required: int, has_optional: bool) -> list[str]:
    """Lines of the enumeration of the indices of the reals, of which the first `required` are not optional.

    Indices of optional reals do not include reals that integers count.
    """
    meanings, lines, index, follows = texts(kind), ["enum {"], 0, ""
    for field, real in declared(kind).items():
        if has_optional and index == required:
            lines += [f"  {size}{follows}", "};", "enum {"]
            follows = f" = {size}" + (f" + {kind._appended}" if kind._appended else "")
        name = kind._c_prefix + (real.name if isinstance(real, Real) and real.name else field).upper()
        meaning = real.meaning if isinstance(real, Real) and real.meaning else meanings[field]
        lines += _entry(f"{name}{follows}", meaning)
        count = len([*each_real(real.kind)]) if isinstance(real, Group) else len(real.parts) or 1
        follows = f" = {name} + {count}" if count > 1 else ""
        if index < required < index + count:  # the last reals of a group are optional
            follows, has_optional = f" = {required}", False
        index += count
    if not index:
        return []
    return [*lines, *([] if has_optional else [f"  {size}{follows}"]), "};"]


def signals_of(kind: type[Element]) -> str:
    """Names of the signals of an element, with their components."""
    if kind._signals is None:
        return "any number"
    return ", ".join(f"{s} ({' or '.join(map(str, n)) if isinstance(n, tuple) else n})" for s, n in kind._signals)


def _sizes(kind: type[Element], required: int) -> dict[str, str]:
    """Fields of `ali3_element_type` that are not 0, with their values."""
    required_reals, optional_reals = kind._real_names()
    counts = [n if isinstance(n, tuple) else (n, n) for _, n in kind._signals or ()]
    space, plane = sum(n for n, _ in counts), sum(n for _, n in counts)
    sizes = {
        "nsig": -1 if kind._signals is None else space,
        "nsig_plane": 0 if plane == space else plane,
        "nreal": -1 if kind._appended is None else len(required_reals) + kind._appended,
        "nreal_more": len(optional_reals),
        "nint": required,
        "nstate": len(kind._states),
        "nstate_more": len(kind._optional_states),
        "nout": len(kind._outputs),
    }
    return {size: str(n) for size, n in sizes.items() if n}


def _sentence(integer: Integer, noun: str) -> str:
    """Message of the kernel about an integer outside its range."""
    if integer.kind is not IntegerKind.NUMBERS:
        kind_noun = "an input" if integer.kind is IntegerKind.INPUTS else "a road"
        return f"{integer.phrase} of {noun} names {kind_noun} that does not exist"
    allowed = " or ".join(map(str, range(integer.least, min(integer.most, integer.least + 3) + 1)))
    requirement = allowed if integer.most < integer.least + 3 else f"at least {integer.least}"
    return f"{integer.phrase} of {noun} must be {requirement}"


def _entry(name: str, meaning: str) -> list[str]:
    """Lines of an enumerator below its meaning."""
    return [*(f"  {line}" for line in _comment(meaning)), f"  {name},"]


def _comment(text: str) -> list[str]:
    first, *following = textwrap.wrap(text, 112)
    lines = [f"/* {first}", *(f" * {line}" for line in following)]
    return [*lines[:-1], f"{lines[-1]} */"]


def headers() -> Iterator[tuple[Path, str]]:
    """Paths of the headers, with their texts."""
    for kind in ElementType:
        yield FOLDER / f"{kind.name.lower()}_fields.h", header(class_of(kind))


def main() -> None:
    """Write all headers."""
    for file, text in headers():
        file.write_text(text, encoding="utf-8", newline="\n")


if __name__ == "__main__":
    main()
