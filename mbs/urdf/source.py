"""Reads the XML elements of a URDF file with their lines, and refuses unsupported content."""

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
_SINGLE_ELEMENTS = {
    "link": ("inertial",),
    "inertial": ("origin", "mass", "inertia"),
    "joint": ("origin", "parent", "child", "axis", "limit", "dynamics", "mimic"),
}
_NEEDED_ATTRIBUTES = {
    "mass": ("value",),
    "inertia": INERTIA,
    "limit": (),
    "origin": (),
    "axis": ("xyz",),
    "mimic": ("joint",),
}
_NUMBER_COUNTS = {
    "origin": {"xyz": 3, "rpy": 3},
    "axis": {"xyz": 3},
    "mass": {"value": 1},
    "inertia": dict.fromkeys(INERTIA, 1),
    "limit": dict.fromkeys(("lower", "upper", "effort", "velocity"), 1),
    "dynamics": {"damping": 1, "friction": 1},
    "mimic": {"multiplier": 1, "offset": 1},
}
"""Count of numbers by element and attribute."""


@dataclass
class Element:
    """An XML element of the file."""

    tag: str
    line: int
    attributes: dict[str, str]
    children: list[Element] = field(default_factory=list)

    def all(self, tag: str) -> Iterator[Element]:
        """Child elements with a tag."""
        return (e for e in self.children if e.tag == tag)

    def first(self, tag: str) -> Element | None:
        """First child element with a tag; None if there is none."""
        return next(self.all(tag), None)

    def numbers(self, name: str) -> list[float]:
        """Numbers of a checked attribute; zeros if it is missing."""
        text = self.attributes.get(name)
        return [0.0] * _NUMBER_COUNTS[self.tag][name] if text is None else [parse_number(part) for part in text.split()]


def read_source(data: bytes, file_name: str) -> Element:
    """Read and check the root element. `file_name`: name of the file, for messages.

    Raises `ModelError` if the data are not XML, or they have a macro, a repeated element that may occur once, text in
    place of a number, or an incomplete inertia.
    """
    parser, document = expat.ParserCreate(), Element("", 0, {})
    path = [document]

    def start(tag: str, attributes: dict[str, str]) -> None:
        if tag.startswith("xacro:"):
            raise ModelError(f"{file_name} has the macro '{tag}'; expand it first: xacro {file_name} > robot.urdf.")
        element = Element(tag, parser.CurrentLineNumber, attributes)
        path[-1].children.append(element)
        path.append(element)

    parser.StartElementHandler, parser.EndElementHandler = start, lambda tag: path.pop()
    try:  # without namespaces: files of robots often use undeclared prefixes
        parser.Parse(data, True)
    except expat.ExpatError as error:
        raise ModelError(f"{file_name} is damaged or no URDF file; as XML it ends with {error}.") from None
    root = document.children[0]
    for child in root.children:
        if child.tag in ("link", "joint"):
            _check_children(child, f"the {child.tag} {brief(child.attributes.get('name', ''))}", file_name)
    return root


def _check_children(element: Element, owner: str, file_name: str) -> None:
    """Check counts and numbers of the child elements. `owner`: link or joint, for messages."""
    for tag in _SINGLE_ELEMENTS.get(element.tag, ()):
        first, *following = [*element.all(tag), *[None] * 2][:2]
        if first is None:
            continue
        if following != [None]:
            second = list(element.all(tag))[1]
            raise ModelError(
                f"{file_name}, line {second.line}: {owner} has a second <{tag}>, after that of line {first.line}; "
                "there must be one."
            )
        _check_numbers(first, owner, file_name)
        _check_children(first, owner, file_name)


def _check_numbers(element: Element, owner: str, file_name: str) -> None:
    """Check the attributes of an element."""
    where = f"{file_name}, line {element.line}: <{element.tag}> of {owner}"
    for name in _NEEDED_ATTRIBUTES.get(element.tag, ()):
        if name not in element.attributes:
            raise ModelError(f"{where} has no {name}; it must have {', '.join(_NEEDED_ATTRIBUTES[element.tag])}.")
    for name, count in _NUMBER_COUNTS.get(element.tag, {}).items():
        text = element.attributes.get(name)
        if text is None:
            continue
        try:
            values = [parse_number(part) for part in text.split()]
        except ValueError as error:
            raise ModelError(f"{where}: {name} is {brief(text)}: {error}.") from None
        largest = sys.float_info.max if element.tag == "limit" else LARGEST  # some files write no limit so
        if len(values) != count or not all(abs(v) <= largest for v in values):
            numbers = "one number" if count == 1 else f"{count} numbers"
            raise ModelError(f"{where}: {name} is {brief(text)}; it must be {numbers} of a size up to {largest:.2g}.")
