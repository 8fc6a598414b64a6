"""Grid points in bulk data of Nastran: fields of 8 or 16 columns or between commas."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_COLUMNS = 72
"""Of a line with data; beyond are marks of continuation."""


def grid_points(path: Path) -> dict[int, tuple[Array, int]]:
    """Places and systems of displacement of all grid points.

    `path`: bulk data, or a whole deck; what it includes is read. Raises `ValueError` or `OSError`: a number is damaged,
    a coordinate system is not there, or an included file.

    Returns
    -------
    dict of int to (array of shape (3,), int)
        By number, ascending: the place in the basic system, and the number of the coordinate system of the
        displacements, 0: the basic one.
    """
    found: dict[str, list[list[str]]] = {}
    for name, *data in _cards(_lines(path)):
        found.setdefault(name, []).append([*data, *[""] * 12])
    systems = _Systems(
        {
            int(data[0]): (name[-1], int(data[1] or 0), np.array([_number(f) for f in data[2:11]]).reshape(3, 3))
            for name in ("CORD2R", "CORD2C", "CORD2S")
            for data in found.get(name, [])
        }
    )
    default = found.get("GRDSET", [[""] * 12])[0]
    points = {}
    for data in found.get("GRID", []):
        number = int(data[0])
        if number in points:
            raise ValueError(f"grid point {number} is given twice")
        given, own = (int(data[k] or default[k] or 0) for k in (1, 5))
        points[number] = systems.basic(np.array([_number(f) for f in data[2:5]]), given), own
    return dict(sorted(points.items()))


class _Systems:
    """Coordinate systems by number: kind, system of reference, and the three points that define each."""

    def __init__(self, given: Mapping[int, tuple[str, int, Array]]) -> None:
        self._given = given
        self._found: dict[int, tuple[str, Array, Array]] = {}

    def basic(self, place: Array, system: int, depth: int = 0) -> Array:
        """A place in the basic system."""
        if system == 0:
            return place
        if system not in self._found:
            self._found[system] = self._axes(system, depth)
        kind, origin, axes = self._found[system]
        return np.asarray(origin + axes @ _RECTANGULAR[kind](*place))

    def _axes(self, system: int, depth: int) -> tuple[str, Array, Array]:
        if system not in self._given:
            raise ValueError(f"coordinate system {system} is defined by no CORD2R, CORD2C or CORD2S")
        if depth > len(self._given):
            raise ValueError(f"coordinate system {system} refers to itself")
        kind, reference, points = self._given[system]
        origin, on_z, in_xz = (self.basic(point, reference, depth + 1) for point in points)
        z, y = on_z - origin, np.cross(on_z - origin, in_xz - origin)
        if not np.linalg.norm(y) > 0.0:
            raise ValueError(f"the points of coordinate system {system} lie on a line")
        z, y = z / np.linalg.norm(z), y / np.linalg.norm(y)
        return kind, origin, np.column_stack([np.cross(y, z), y, z])


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
    """A number, whose exponent may be written without its letter: 1.-3; an empty field is 0."""
    return float(re.sub(r"(?<=[\d.])([+-])", r"e\1", field.lower().replace("d", "e"))) if field else 0.0


def _lines(path: Path, depth: int = 0) -> Iterator[str]:
    """Lines without comments, and those of included files in their place."""
    if depth > 20:
        raise ValueError(f"{path.name} is included within itself")
    for raw in path.read_text(encoding="latin-1").splitlines():
        line = raw.partition("$")[0].expandtabs(8).rstrip()
        if included := re.match(r"include\s+['\"]?([^'\"]+)", line, re.IGNORECASE):
            yield from _lines(path.parent / included[1].strip(), depth + 1)
        elif line:
            yield line


def _cards(lines: Iterator[str]) -> Iterator[list[str]]:
    """Name and data of each card, with the lines that continue it."""
    card: list[str] = []
    for line in lines:
        fields = _fields(line)
        if fields[0] and fields[0][0] not in "+*":
            if card:
                yield card
            card = [fields[0].rstrip("*").upper()]
        card += fields[1:]
    if card:
        yield card


def _fields(line: str) -> list[str]:
    """The first field of a line, and its data."""
    if "," in line:
        fields = [field.strip() for field in line.split(",")]
        count = 4 if fields[0].endswith("*") else 8
        return (fields + [""] * count)[: 1 + count]
    first = line[:8].strip()
    wide = 16 if first.endswith("*") or first.startswith("*") else 8
    data = line[8:_COLUMNS].ljust(_COLUMNS - 8)
    return [first, *(data[k : k + wide].strip() for k in range(0, _COLUMNS - 8, wide))]
