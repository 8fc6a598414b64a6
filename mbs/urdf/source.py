"""Source of a URDF file: elements with their lines, and errors for unsupported content."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import dataclass, field
from xml.parsers import expat

from ali3.decimal_number import parse_number
from ali3.message_text import brief
from mbs.common.checks import LARGEST
from mbs.common.errors import ModelError

INERTIA = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
_ONCE = {
    "link": ("inertial",),
    "inertial": ("origin", "mass", "inertia"),
    "joint": ("origin", "parent", "child", "axis", "limit", "dynamics", "mimic"),
}
_NEEDED = {"mass": ("value",), "inertia": INERTIA, "limit": (), "origin": (), "axis": ("xyz",), "mimic": ("joint",)}
_NUMBERS = {
    "origin": {"xyz": 3, "rpy": 3},
    "axis": {"xyz": 3},
    "mass": {"value": 1},
    "inertia": dict.fromkeys(INERTIA, 1),
    "limit": dict.fromkeys(("lower", "upper", "effort", "velocity"), 1),
    "dynamics": {"damping": 1, "friction": 1},
    "mimic": {"multiplier": 1, "offset": 1},
}
"""How many numbers each attribute has."""


@dataclass
class Element:
    """An element of the file."""

    tag: str
    line: int
    attributes: dict[str, str]
    inside: list[Element] = field(default_factory=list)

    def all(self, tag: str) -> Iterator[Element]:
        """The elements of a name directly in it."""
        return (e for e in self.inside if e.tag == tag)

    def first(self, tag: str) -> Element | None:
        """The first of a name directly in it."""
        return next(self.all(tag), None)

    def numbers(self, name: str) -> list[float]:
        """Numbers of an attribute that was checked; zeros where it is not there."""
        text = self.attributes.get(name)
        return [0.0] * _NUMBERS[self.tag][name] if text is None else [parse_number(part) for part in text.split()]


def read_source(data: bytes, what: str) -> Element:
    """The root of the elements, checked. `what`: the file, for messages.

    Raises `ModelError`: it is not XML, has macros, an element twice that may occur once, text in place of a number, or
    an inertia without a part; with the line.
    """
    parser, document = expat.ParserCreate(), Element("", 0, {})
    path = [document]

    def start(tag: str, attributes: dict[str, str]) -> None:
        if tag.startswith("xacro:"):
            raise ModelError(f"{what} has the macro '{tag}'; expand it first: xacro {what} > robot.urdf.")
        element = Element(tag, parser.CurrentLineNumber, attributes)
        path[-1].inside.append(element)
        path.append(element)

    parser.StartElementHandler, parser.EndElementHandler = start, lambda tag: path.pop()
    try:  # the reader takes what it understands; prefixes of robots are often of no namespace
        parser.Parse(data, True)
    except expat.ExpatError as error:
        raise ModelError(f"{what} is damaged or no URDF file; as XML it ends with {error}.") from None
    root = document.inside[0]
    for child in root.inside:
        if child.tag in ("link", "joint"):
            _check(child, f"the {child.tag} {brief(child.attributes.get('name', ''))}", what)
    return root


def _check(element: Element, whose: str, what: str) -> None:
    for tag in _ONCE.get(element.tag, ()):
        first, *following = [*element.all(tag), *[None] * 2][:2]
        if first is None:
            continue
        if following != [None]:
            second = list(element.all(tag))[1]
            raise ModelError(
                f"{what}, line {second.line}: {whose} has a second <{tag}>, after that of line {first.line}; "
                "there must be one."
            )
        _numbers(first, whose, what)
        _check(first, whose, what)


def _numbers(element: Element, whose: str, what: str) -> None:
    where = f"{what}, line {element.line}: <{element.tag}> of {whose}"
    for name in _NEEDED.get(element.tag, ()):
        if name not in element.attributes:
            raise ModelError(f"{where} has no {name}; it must have {', '.join(_NEEDED[element.tag])}.")
    for name, count in _NUMBERS.get(element.tag, {}).items():
        text = element.attributes.get(name)
        if text is None:
            continue
        try:
            values = [parse_number(part) for part in text.split()]
        except ValueError as error:
            raise ModelError(f"{where}: {name} is {brief(text)}: {error}.") from None
        largest = sys.float_info.max if element.tag == "limit" else LARGEST  # some write no limit so
        if len(values) != count or not all(abs(v) <= largest for v in values):
            numbers = "one number" if count == 1 else f"{count} numbers"
            raise ModelError(f"{where}: {name} is {brief(text)}; it must be {numbers} of a size up to {largest:.2g}.")
