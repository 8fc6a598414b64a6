"""Grid points in bulk data of Nastran: fields of 8 or 16 columns or between commas, with tabs and replication."""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ali3.message_text import brief
from ali3.named_files import NamedFiles
from ali3.reading import read_bytes
from mbs.common.checks import LARGEST as LARGEST_NUMBER
from mbs.common.errors import ModelError
from mbs.flexible.foreign_file import MAX_BYTES

Array = NDArray[np.float64]
_COLUMNS = 72
"""Columns of data in a line; the mark of continuation follows."""
_MAX_REPEATS = 1_000_000
_SYSTEMS = ("CORD2R", "CORD2C", "CORD2S")
_USED_CARDS = (*_SYSTEMS, "GRDSET", "GRID")


@dataclass(frozen=True)
class _Line:
    """A line without its comment, with its location."""

    location: str
    text: str

    def error(self, message: str) -> ModelError:
        return ModelError(f"{self.location}: {message}")


@dataclass(frozen=True)
class _Card:
    """A card: its name and data, with continuation lines."""

    line: _Line
    name: str
    data: list[str]

    def field(self, k: int) -> str:
        return self.data[k] if k < len(self.data) else ""

    def whole(self, k: int) -> int:
        """A field as a whole number; 0 if it is empty."""
        return int(self._read(k, int, "whole number"))

    def numbers(self, first: int, count: int) -> Array:
        """`count` fields, the first at `first`, as numbers; 0 for empty ones."""
        numbers = np.array([self._read(k, _number, "number") for k in range(first, first + count)])
        if not (np.abs(numbers) <= LARGEST_NUMBER).all():
            raise self.line.error(f"a number of this {self.name} is not finite or beyond {LARGEST_NUMBER:g}.")
        return numbers

    def _read(self, k: int, reader: Callable[[str], float], kind: str) -> float:
        try:
            return reader(self.field(k)) if self.field(k) else 0
        except ValueError:
            raise self.line.error(f"field {k + 2} of this {self.name} is {brief(self.field(k))}, no {kind}.") from None


def grid_points(path: Path, folder: str | Path | None = None) -> dict[int, tuple[Array, int]]:
    """Positions and displacement systems of all grid points.

    `path`: bulk data or a whole deck, with included files; `folder`: folder of the included files, by default its own.
    Raises `ModelError` with file and line: a number is damaged, or a coordinate system or an included file is missing.

    Returns
    -------
    dict of int to (array of shape (3,), int)
        By ascending number: the position in the basic system, and the number of the coordinate system of the
        displacements, 0 for the basic one.
    """
    cards: dict[str, list[_Card]] = {}
    lines = list(_lines(path, NamedFiles(path.parent if folder is None else folder, MAX_BYTES, ModelError)))
    begin = next((k + 1 for k, line in enumerate(lines) if re.match(r"begin\s+bulk", line.text, re.IGNORECASE)), 0)
    end = next((k for k, line in enumerate(lines) if re.match(r"enddata\b", line.text, re.IGNORECASE)), len(lines))
    for card in _cards(lines[begin:end]):
        cards.setdefault(card.name, []).append(card)
    systems = _Systems({card.whole(0): card for name in _SYSTEMS for card in cards.get(name, [])})
    default = cards.get("GRDSET", [_Card(_Line("", ""), "GRDSET", [])])[0]
    points = {}
    for card in cards.get("GRID", []):
        number = card.whole(0)
        if number in points:
            raise card.line.error(f"grid point {number} is given twice.")
        position_system, displacement_system = ((card if card.field(k) else default).whole(k) for k in (1, 5))
        points[number] = systems.basic(card.numbers(2, 3), position_system, card.line), displacement_system
    if not points:
        raise ModelError(f"{path.name} contains no grid points.")
    return dict(sorted(points.items()))


class _Systems:
    """Coordinate systems by number, each defined by three points in a reference system."""

    def __init__(self, cards: Mapping[int, _Card]) -> None:
        self._cards = cards
        self._computed: dict[int, tuple[str, Array, Array]] = {}

    def basic(self, position: Array, system: int, line: _Line, depth: int = 0) -> Array:
        """A position in the basic system. `line`: refers to the system, for errors."""
        if system == 0:
            return position
        if system not in self._computed:
            self._computed[system] = self._axes(system, line, depth)
        kind, origin, axes = self._computed[system]
        return np.asarray(origin + axes @ _RECTANGULAR[kind](*position))

    def _axes(self, system: int, line: _Line, depth: int) -> tuple[str, Array, Array]:
        if system not in self._cards:
            raise line.error(f"coordinate system {system} is defined by no CORD2R, CORD2C or CORD2S.")
        if depth > len(self._cards):
            raise line.error(f"coordinate system {system} refers to itself.")
        card = self._cards[system]
        points, reference = card.numbers(2, 9).reshape(3, 3), card.whole(1)
        origin, on_z, in_xz = (self.basic(point, reference, card.line, depth + 1) for point in points)
        z, y = on_z - origin, np.cross(on_z - origin, in_xz - origin)
        if not np.linalg.norm(y) > 0.0:
            raise card.line.error(f"the points of coordinate system {system} lie on a line.")
        z, y = z / np.linalg.norm(z), y / np.linalg.norm(y)
        return card.name[-1], origin, np.column_stack([np.cross(y, z), y, z])


def _cylindrical(r: float, degrees: float, z: float) -> Array:
    angle = np.radians(degrees)
    return np.array([r * np.cos(angle), r * np.sin(angle), z])


def _spherical(r: float, polar_degrees: float, degrees: float) -> Array:
    angle = np.radians(polar_degrees)
    return _cylindrical(r * np.sin(angle), degrees, r * np.cos(angle))


_RECTANGULAR: dict[str, Callable[..., Array]] = {
    "R": lambda x, y, z: np.array([x, y, z]),
    "C": _cylindrical,
    "S": _spherical,
}
"""Rectangular coordinates of a position, by the last letter of the card of its system; angles in degrees."""


def _number(field: str) -> float:
    """A number, whose exponent may lack its letter, as in 1.-3."""
    return float(re.sub(r"(?<=[\d.])([+-])", r"e\1", field.lower().replace("d", "e")))


def _lines(path: Path, included: NamedFiles, depth: int = 0) -> Iterator[_Line]:
    """Lines without comments, with the lines of included files at their position."""
    text = read_bytes(path, MAX_BYTES, ModelError, path.name).decode("latin-1")
    for number, raw in enumerate(text.splitlines(), 1):
        line = _Line(f"{path.name}, line {number}", raw.partition("$")[0].rstrip())
        if include := re.match(r"include\s+['\"]?([^'\"]+)", line.text, re.IGNORECASE):
            if depth == 20:
                raise line.error(f"{path.name} is included within itself.")
            yield from _lines(included.file(include[1].strip(), path.parent, line.location), included, depth + 1)
        elif line.text:
            yield line


def _cards(lines: Sequence[_Line]) -> Iterator[_Card]:
    """Used cards; replications are expanded."""
    previous, rule = _Card(_Line("", ""), "", []), list[str]()
    for card in _join_cards(lines):
        is_repeat = card.name.startswith("=")
        if not is_repeat and not {"=", "=="} & {*card.data}:
            previous, rule = card, []
        elif (previous if is_repeat else card).name in _USED_CARDS:
            repeats = re.fullmatch(r"=\(?(\d+)\)?", card.name)
            rule = rule if repeats else card.data
            if not rule:
                raise card.line.error(f"{card.name} repeats a replication, and the line before it is none.")
            count = int(repeats[1]) if repeats else 1
            if count > _MAX_REPEATS:
                raise card.line.error(f"{card.name} repeats a card more than {_MAX_REPEATS} times.")
            for _ in range(count):
                previous = _Card(
                    card.line, previous.name if is_repeat else card.name, _replicate(rule, previous.data, card.line)
                )
                yield previous
            continue
        if card.name in _USED_CARDS:
            yield card


def _replicate(rule: Sequence[str], previous_data: Sequence[str], line: _Line) -> list[str]:
    """Data of a replicated card: ``=`` copies a field of the card before, ``==`` all that follow, ``*(n)`` adds n."""
    fields = list[str]()
    for k, field in enumerate(rule):
        previous = previous_data[k] if k < len(previous_data) else ""
        increment = re.fullmatch(r"\*\(?([^()]+)\)?", field)
        if field == "==":
            return [*fields, *previous_data[k:]]
        if increment is None:
            fields.append(previous if field == "=" else field)
            continue
        try:
            is_whole = re.fullmatch(r"[+-]?\d+", previous) and re.fullmatch(r"[+-]?\d+", increment[1])
            fields.append(
                str(int(previous) + int(increment[1])) if is_whole else repr(_number(previous) + _number(increment[1]))
            )
        except ValueError:
            raise line.error(
                f"field {k + 2} adds {brief(increment[1])} to {brief(previous)}, which are not both numbers."
            ) from None
    return fields


def _join_cards(lines: Sequence[_Line]) -> Iterator[_Card]:
    """Cards with their continuation lines, not expanded; unused cards have no data."""
    card, mark = _Card(_Line("", ""), "", []), ""
    for line in lines:
        first = (line.text.partition(",")[0] if "," in line.text else line.text.expandtabs(8)[:8]).strip()
        if first and first[0] not in "+*":
            yield card
            card = _Card(line, first.rstrip("*").upper(), [])
        if card.name in _USED_CARDS or card.name.startswith("="):
            label = first[1:].strip()
            if card.line is not line and mark and label and mark != label:
                raise line.error(
                    f"it continues a line that ends with {brief(label)}, and the one of the {card.name} before it ends "
                    f"with {brief(mark)}; lines that continue a card must follow it."
                )
            data, mark = _split_fields(line, first)
            card.data.extend(data)
    yield card


def _split_fields(line: _Line, first: str) -> tuple[list[str], str]:
    """Data of a line, and the mark of its continuation without its sign. `first`: field 1."""
    width = 16 if first.endswith("*") or first.startswith("*") else 8
    count = (_COLUMNS - 8) // width
    if "," in line.text:
        fields = [field.strip() for field in line.text.split(",")[1:]] + [""] * (count + 1)
        return fields[:count], fields[count][1:].strip()
    text = _expand_tabs(line, width)
    data = text[8:_COLUMNS].ljust(_COLUMNS - 8)
    return [data[k : k + width].strip() for k in range(0, _COLUMNS - 8, width)], text[_COLUMNS + 1 :].strip()


def _expand_tabs(line: _Line, width: int) -> str:
    """Text of a line with each tab replaced by blanks up to the next field."""
    text = ""
    *pieces, last = line.text.split("\t")
    for piece in pieces:
        text += piece
        first, end = (0, 8) if len(text) < 8 else (8 + width * ((len(text) - 8) // width + k) for k in (0, 1))
        if text.rfind(" ") + 1 < min(first, len(text)):
            raise line.error(
                f"{brief(text.split()[-1])} fills its field or is longer, and a tab follows, so that the next field is "
                "ambiguous; write blanks or commas."
            )
        text = text.ljust(end)
    return text + last
