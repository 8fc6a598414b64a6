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
from mbs.flexible.foreign_file import LARGEST

Array = NDArray[np.float64]
_COLUMNS = 72
"""Of a line with data; beyond are marks of continuation."""
_MOST_REPEATS = 1_000_000
_SYSTEMS = ("CORD2R", "CORD2C", "CORD2S")
_USED = (*_SYSTEMS, "GRDSET", "GRID")


@dataclass(frozen=True)
class _Line:
    """A line without its comment, and where it stands."""

    where: str
    text: str

    def error(self, words: str) -> ModelError:
        return ModelError(f"{self.where}: {words}")


@dataclass(frozen=True)
class _Card:
    """A name and its data, with the lines that continue it."""

    line: _Line
    name: str
    data: list[str]

    def field(self, k: int) -> str:
        return self.data[k] if k < len(self.data) else ""

    def whole(self, k: int) -> int:
        """A field as a whole number; 0 where it is empty."""
        return int(self._read(k, int, "whole number"))

    def numbers(self, first: int, count: int) -> Array:
        """Fields as numbers; 0 where one is empty."""
        numbers = np.array([self._read(k, _number, "number") for k in range(first, first + count)])
        if not (np.abs(numbers) <= LARGEST_NUMBER).all():
            raise self.line.error(f"a number of this {self.name} is not finite or beyond {LARGEST_NUMBER:g}.")
        return numbers

    def _read(self, k: int, reader: Callable[[str], float], what: str) -> float:
        try:
            return reader(self.field(k)) if self.field(k) else 0
        except ValueError:
            raise self.line.error(f"field {k + 2} of this {self.name} is {brief(self.field(k))}, no {what}.") from None


def grid_points(path: Path, folder: str | Path | None = None) -> dict[int, tuple[Array, int]]:
    """Places and systems of displacement of all grid points.

    `path`: bulk data, or a whole deck; what it includes is read; `folder`: below which that lies; by default its own.
    Raises `ModelError` with file and line: a number is damaged, a coordinate system or an included file is not there.

    Returns
    -------
    dict of int to (array of shape (3,), int)
        By number, ascending: the place in the basic system, and the number of the coordinate system of the
        displacements, 0: the basic one.
    """
    cards: dict[str, list[_Card]] = {}
    lines = list(_lines(path, NamedFiles(path.parent if folder is None else folder, LARGEST, ModelError)))
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
    """Coordinate systems by number: each has a system of reference, and three points that define it."""

    def __init__(self, given: Mapping[int, _Card]) -> None:
        self._given = given
        self._found: dict[int, tuple[str, Array, Array]] = {}

    def basic(self, place: Array, system: int, line: _Line, depth: int = 0) -> Array:
        """A place in the basic system. `line`: that asks for it."""
        if system == 0:
            return place
        if system not in self._found:
            self._found[system] = self._axes(system, line, depth)
        kind, origin, axes = self._found[system]
        return np.asarray(origin + axes @ _RECTANGULAR[kind](*place))

    def _axes(self, system: int, line: _Line, depth: int) -> tuple[str, Array, Array]:
        if system not in self._given:
            raise line.error(f"coordinate system {system} is defined by no CORD2R, CORD2C or CORD2S.")
        if depth > len(self._given):
            raise line.error(f"coordinate system {system} refers to itself.")
        card = self._given[system]
        points, reference = card.numbers(2, 9).reshape(3, 3), card.whole(1)
        origin, on_z, in_xz = (self.basic(point, reference, card.line, depth + 1) for point in points)
        z, y = on_z - origin, np.cross(on_z - origin, in_xz - origin)
        if not np.linalg.norm(y) > 0.0:
            raise card.line.error(f"the points of coordinate system {system} lie on a line.")
        z, y = z / np.linalg.norm(z), y / np.linalg.norm(y)
        return card.name[-1], origin, np.column_stack([np.cross(y, z), y, z])


def _cylindrical(r: float, turn: float, z: float) -> Array:
    angle = np.radians(turn)
    return np.array([r * np.cos(angle), r * np.sin(angle), z])


def _spherical(r: float, from_z: float, turn: float) -> Array:
    angle = np.radians(from_z)
    return _cylindrical(r * np.sin(angle), turn, r * np.cos(angle))


_RECTANGULAR: dict[str, Callable[..., Array]] = {
    "R": lambda x, y, z: np.array([x, y, z]),
    "C": _cylindrical,
    "S": _spherical,
}
"""Coordinates of a place by the last letter of its system's card; angles in degrees."""


def _number(field: str) -> float:
    """A number, whose exponent may be written without its letter: 1.-3."""
    return float(re.sub(r"(?<=[\d.])([+-])", r"e\1", field.lower().replace("d", "e")))


def _lines(path: Path, included: NamedFiles, depth: int = 0) -> Iterator[_Line]:
    """Lines without comments, and those of included files in their place."""
    text = read_bytes(path, LARGEST, ModelError, path.name).decode("latin-1")
    for number, raw in enumerate(text.splitlines(), 1):
        line = _Line(f"{path.name}, line {number}", raw.partition("$")[0].rstrip())
        if named := re.match(r"include\s+['\"]?([^'\"]+)", line.text, re.IGNORECASE):
            if depth == 20:
                raise line.error(f"{path.name} is included within itself.")
            yield from _lines(included.file(named[1].strip(), path.parent, line.where), included, depth + 1)
        elif line.text:
            yield line


def _cards(lines: Sequence[_Line]) -> Iterator[_Card]:
    """Cards that are used, those that replicate the one before them written out."""
    before, rule = _Card(_Line("", ""), "", []), list[str]()
    for card in _joined(lines):
        again = card.name.startswith("=")
        if not again and not {"=", "=="} & {*card.data}:
            before, rule = card, []
        elif (before if again else card).name in _USED:
            repeats = re.fullmatch(r"=\(?(\d+)\)?", card.name)
            rule = rule if repeats else card.data
            if not rule:
                raise card.line.error(f"{card.name} repeats a replication, and the line before it is none.")
            count = int(repeats[1]) if repeats else 1
            if count > _MOST_REPEATS:
                raise card.line.error(f"{card.name} repeats a card more than {_MOST_REPEATS} times.")
            for _ in range(count):
                before = _Card(
                    card.line, before.name if again else card.name, _replicated(rule, before.data, card.line)
                )
                yield before
            continue
        if card.name in _USED:
            yield card


def _replicated(rule: Sequence[str], before: Sequence[str], line: _Line) -> list[str]:
    """Data of a card: ``=`` that before it, ``==`` all from there on, ``*(n)`` that before it and n more."""
    fields = list[str]()
    for k, field in enumerate(rule):
        previous = before[k] if k < len(before) else ""
        increment = re.fullmatch(r"\*\(?([^()]+)\)?", field)
        if field == "==":
            return [*fields, *before[k:]]
        if increment is None:
            fields.append(previous if field == "=" else field)
            continue
        try:
            whole = re.fullmatch(r"[+-]?\d+", previous) and re.fullmatch(r"[+-]?\d+", increment[1])
            fields.append(
                str(int(previous) + int(increment[1])) if whole else repr(_number(previous) + _number(increment[1]))
            )
        except ValueError:
            raise line.error(
                f"field {k + 2} adds {brief(increment[1])} to {brief(previous)}, which are not both numbers."
            ) from None
    return fields


def _joined(lines: Sequence[_Line]) -> Iterator[_Card]:
    """Cards as they stand there, each with the lines that continue it; of a card that is not used the name."""
    card, mark = _Card(_Line("", ""), "", []), ""
    for line in lines:
        first = (line.text.partition(",")[0] if "," in line.text else line.text.expandtabs(8)[:8]).strip()
        if first and first[0] not in "+*":
            yield card
            card = _Card(line, first.rstrip("*").upper(), [])
        if card.name in _USED or card.name.startswith("="):
            label = first[1:].strip()
            if card.line is not line and mark and label and mark != label:
                raise line.error(
                    f"it continues a line that ends with {brief(label)}, and the one of the {card.name} before it ends "
                    f"with {brief(mark)}; lines that continue a card must follow it."
                )
            data, mark = _data(line, first)
            card.data.extend(data)
    yield card


def _data(line: _Line, first: str) -> tuple[list[str], str]:
    """The data of a line, and the mark that the line which continues it has too, without its sign. `first`: field 1."""
    wide = 16 if first.endswith("*") or first.startswith("*") else 8
    count = (_COLUMNS - 8) // wide
    if "," in line.text:
        fields = [field.strip() for field in line.text.split(",")[1:]] + [""] * (count + 1)
        return fields[:count], fields[count][1:].strip()
    text = _without_tabs(line, wide)
    data = text[8:_COLUMNS].ljust(_COLUMNS - 8)
    return [data[k : k + wide].strip() for k in range(0, _COLUMNS - 8, wide)], text[_COLUMNS + 1 :].strip()


def _without_tabs(line: _Line, wide: int) -> str:
    """A line in which each tab leads to the next field."""
    row = ""
    *pieces, last = line.text.split("\t")
    for piece in pieces:
        row += piece
        first, end = (0, 8) if len(row) < 8 else (8 + wide * ((len(row) - 8) // wide + k) for k in (0, 1))
        if row.rfind(" ") + 1 < min(first, len(row)):
            raise line.error(
                f"{brief(row.split()[-1])} fills its field or is longer, and a tab follows, so that the next field is "
                "ambiguous; write blanks or commas."
            )
        row = row.ljust(end)
    return row + last
