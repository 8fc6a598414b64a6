"""Courses of a description: from segments, points or a CSV file to layers, and what is wrong with them."""

from __future__ import annotations

import itertools
import math
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ali3.tables import TextTable
from ali3.words import brief
from mbs.roads.road_header import RoadFileError
from mbs.worlds.centre_line import CentreLine, of_segments, through
from mbs.worlds.layers import CourseLayer, HeightOf
from mbs.worlds.world_types import Course

Float = NDArray[np.float64]
COLUMNS = ("x", "y", "z", "width", "bank")
GAP = 25.0
"""Two points that are so many times as far apart as the others, and 10 m, are a gap."""


def course_layer(
    course: Course, folder: Path, bounds: tuple[float, float, float, float], ground: HeightOf
) -> CourseLayer:
    """A course as it is laid on the ground. Raises `RoadFileError` with what is wrong with the course."""
    given = [name for name in ("segments", "points") if getattr(course, name) is not None]
    if len(given) != 1:
        raise RoadFileError(f"The course '{course.name}' must have segments or points, one of them.")
    if course.segments is not None:
        if course.start is None:
            raise RoadFileError(f"The course '{course.name}' has segments; it needs a start, [x, y, yaw in degrees].")
        line = of_segments(course.start, course.segments, course.closed, course.name)
        table: dict[str, Float] = {}
    else:
        table = _table(course, folder)
        line = through(np.stack([table["x"], table["y"]], axis=1), course.closed, course.name)
    _inside(line, course, bounds)
    _crossings(line, course)
    if course.heights is not None:
        _rising([s for s, _ in course.heights], course, "heights")
    if course.bank is not None:
        _rising([s for s, _ in course.bank.grades], course, "bank.grades")
    along = _along(line, table)
    return CourseLayer(course, line, ground, *(along.get(name) for name in ("z", "width", "bank")))


def _table(course: Course, folder: Path) -> dict[str, Float]:
    """Columns of a course's points."""
    if not isinstance(course.points, str):
        assert course.points is not None
        table = dict(zip("xy", np.array(course.points, float).T, strict=True)) if course.points else {}
        name = f"The course '{course.name}'"
    else:
        file = folder / course.points
        table, name = read_course(file), str(file)
    if not table or len(table["x"]) < 2:
        raise RoadFileError(f"{name} has fewer than two points.")
    x, y = table["x"], table["y"]
    way = np.hypot(np.diff(x), np.diff(y))
    if float(way.sum()) < 1.0:
        raise RoadFileError(f"{name} is {way.sum():.3g} long; x and y must be in metres, not in degrees or kilometres.")
    k = int(np.argmax(way))
    if len(way) > 3 and way[k] > max(GAP * float(np.median(way)), 10.0):
        raise RoadFileError(
            f"{name} has a gap of {way[k]:.4g} m between points {k + 1} and {k + 2}, where others are "
            f"{float(np.median(way)):.3g} m apart."
        )
    for column, low, high, unit in (("width", 1.0, 200.0, "metres"), ("bank", -1.0, 1.0, "a slope, 0.1 is 10 %")):
        if column in table and not ((table[column] >= low) & (table[column] <= high)).all():
            k = int(np.argmax((table[column] < low) | (table[column] > high)))
            raise RoadFileError(
                f"{name}: {column} of point {k + 1} is {table[column][k]:g}; it must lie between {low:g} and {high:g} "
                f"({unit})."
            )
    if "z" in table:
        grades = np.abs(np.diff(table["z"])) / np.maximum(way, 1e-9)
        k = int(np.argmax(grades))
        if grades[k] > 1.0:
            raise RoadFileError(
                f"{name} rises by {100.0 * grades[k]:.0f} % between points {k + 1} and {k + 2}; z must be in metres."
            )
    return table


def read_course(file: Path) -> dict[str, Float]:
    """Columns of a course file by name.

    `file`: CSV; its first line may name the columns x, y, z, width and bank, else they are x, y and then z, width, bank
    as far as there are any. Lines that begin with # are left out. Raises `RoadFileError` with the file, the line and
    what is wrong.
    """
    table = TextTable(file, RoadFileError, headed=None)
    names = [name.lower() for name in table.names] or list(COLUMNS[: table.width])
    if unknown := [name for name in names if name not in COLUMNS]:
        raise RoadFileError(f"{file} has a column {brief(unknown[0])}; known are {', '.join(COLUMNS)}, in metres.")
    if not {"x", "y"} <= set(names) or len(set(names)) < len(names):
        raise RoadFileError(f"{file} must have a column x and a column y, each once.")
    if table.width > len(names):
        raise RoadFileError(f"{file} has {table.width} columns; without names they are {', '.join(COLUMNS)}.")
    return dict(zip(names, table.values(least=0).T, strict=True))


def _inside(line: CentreLine, course: Course, bounds: tuple[float, float, float, float]) -> None:
    x0, y0, x1, y1 = bounds
    x, y = line.points.T
    out = (x < x0) | (x > x1) | (y < y0) | (y > y1)
    if out.any():
        k = int(np.argmax(out))
        raise RoadFileError(
            f"The course '{course.name}' leaves the world at station {k * line.step:.0f} m, x = {x[k]:.6g}, y = "
            f"{y[k]:.6g}; the world reaches from ({x0:g}, {y0:g}) to ({x1:g}, {y1:g}) m."
        )


def _crossings(line: CentreLine, course: Course) -> None:
    """A course may not cross itself: it would have two heights there."""
    from scipy.spatial import cKDTree

    s = line.stations[:-1] if line.closed else line.stations
    points = line.points[: len(s)]
    width = course.width
    pairs = cKDTree(points).query_pairs(0.9 * width, output_type="ndarray")
    if len(pairs) == 0:
        return
    apart = np.abs(s[pairs[:, 1]] - s[pairs[:, 0]])
    if line.closed:
        apart = np.minimum(apart, line.length - apart)
    back = pairs[apart > 3.2 * width]
    if len(back):
        a, b = back[0]
        raise RoadFileError(
            f"The course '{course.name}' crosses or touches itself at x = {points[a][0]:.5g}, y = {points[a][1]:.5g} "
            f"(stations {s[a]:.0f} and {s[b]:.0f} m); split it into courses, of which the later one lies on top."
        )


def _rising(stations: list[float], course: Course, what: str) -> None:
    if any(b <= a for a, b in itertools.pairwise(stations)):
        raise RoadFileError(f"The stations of {what} of the course '{course.name}' do not rise: {stations}.")


def _along(line: CentreLine, table: dict[str, Float]) -> dict[str, Float]:
    """Columns of a file at the points of the line."""
    names = [name for name in ("z", "width", "bank") if name in table]
    if not names:
        return {}
    x, y = table["x"], table["y"]
    if line.closed and math.hypot(x[0] - x[-1], y[0] - y[-1]) > 1e-9:
        table = {name: np.append(values, values[0]) for name, values in table.items()}
        x, y = table["x"], table["y"]
    s = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
    return {name: np.interp(line.stations, s * line.length / s[-1], table[name]) for name in names}
