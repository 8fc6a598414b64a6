"""Makes checked layers of courses from segments, points or CSV files."""

import itertools
import math
import re
import warnings
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ali3.message_text import brief
from ali3.named_files import NamedFiles
from ali3.tables import LARGEST, TextTable
from mbs.roads.road_header import RoadFileError
from mbs.roads.steep_faces import RoadWarning
from mbs.worlds.centre_line import CentreLine, curve_through, line_of_segments, line_through
from mbs.worlds.layers import CourseLayer, HeightOf
from mbs.worlds.world_types import Course

Float = NDArray[np.float64]
COLUMNS = {
    "x": "x",
    "y": "y",
    "z": "z",
    "width": "width",
    "bank": "bank",
    "right": "right",
    "left": "left",
    "width_right": "right",
    "width_left": "left",
    "right_width": "right",
    "left_width": "left",
    "w_tr_right": "right",
    "w_tr_left": "left",
}
"""Quantity of a column by its heading. `right`, `left`: distances from the line of the file to the edges."""
DEFAULT_COLUMNS = ("x", "y", "z", "width")
_HEADING_IN_METRES = re.compile(r"(.*?)(?:_m|_?\[m\]|_?\(m\))?")
KNOWN_COLUMNS = (
    "x, y, z, width, or right and left (widths from the line to each edge, as w_tr_right_m and w_tr_left_m), all in "
    "metres, and bank (a slope)"
)
MAX_GRADE = 0.3
"""Grade above which a warning is given: the steepest streets have 0.35."""
GAP_RATIO = 25.0
"""Distance of two points, relative to the median distance, from which it is a gap, if it is 10 m or more."""


def course_layer(
    course: Course, folder: Path, bounds: tuple[float, float, float, float], ground: HeightOf
) -> CourseLayer:
    """Make the layer of a course on the ground.

    `bounds`: bounds of the world, m. Raises `RoadFileError` if the course is not valid.
    """
    sources = [name for name in ("segments", "points") if getattr(course, name) is not None]
    if len(sources) != 1:
        raise RoadFileError(f"The course '{course.name}' must have segments or points, one of them.")
    if course.segments is not None:
        if course.start is None:
            raise RoadFileError(f"The course '{course.name}' has segments; it needs a start, [x, y, yaw in degrees].")
        line = line_of_segments(course.start, course.segments, course.closed, course.name)
        table: dict[str, Float] = {}
    else:
        table = _points_table(course, folder)
        line = line_through(np.stack([table["x"], table["y"]], axis=1), course.closed, course.name)
    _check_bounds(line, course, bounds)
    columns = _at_stations(line, table)
    _check_crossings(line, course, columns.get("width", np.full(len(line.points), course.width)))
    if course.heights is not None:
        _check_rising([s for s, _ in course.heights], course, "heights")
    if course.bank is not None:
        _check_rising([s for s, _ in course.bank.grades], course, "bank.grades")
    layer = CourseLayer(course, line, ground, *(columns.get(name) for name in ("z", "width", "bank")))
    if warning := _grade_warning(layer):
        warnings.warn(warning, RoadWarning, stacklevel=2)
    return layer


def _points_table(course: Course, folder: Path) -> dict[str, Float]:
    """Read and check the columns of a course's points."""
    if not isinstance(course.points, str):
        assert course.points is not None
        table = dict(zip("xy", np.array(course.points, float).T, strict=True)) if course.points else {}
        name = f"The course '{course.name}'"
    else:
        named = NamedFiles(folder, LARGEST, RoadFileError)
        file = named.file(course.points, folder, f"The points of the course '{course.name}'")
        table, name = read_course(file), str(file)
        if "right" in table:
            table["width"] = table["left"] + table["right"]
    if not table or len(table["x"]) < 2:
        raise RoadFileError(f"{name} has fewer than two points.")
    x, y = table["x"], table["y"]
    distances = np.hypot(np.diff(x), np.diff(y))
    if float(distances.sum()) < 1.0:
        raise RoadFileError(
            f"{name} is {distances.sum():.3g} long; x and y must be in metres, not in degrees or kilometres."
        )
    k = int(np.argmax(distances))
    if len(distances) > 3 and distances[k] > max(GAP_RATIO * float(np.median(distances)), 10.0):
        raise RoadFileError(
            f"{name} has a gap of {distances[k]:.4g} m between points {k + 1} and {k + 2}, where others are "
            f"{float(np.median(distances)):.3g} m apart."
        )
    for column, low, high, unit in (("width", 1.0, 200.0, "metres"), ("bank", -1.0, 1.0, "a slope, 0.1 is 10 %")):
        if column in table and not ((table[column] >= low) & (table[column] <= high)).all():
            k = int(np.argmax((table[column] < low) | (table[column] > high)))
            raise RoadFileError(
                f"{name}: {column} of point {k + 1} is {table[column][k]:g}; it must lie between {low:g} and {high:g} "
                f"({unit})."
            )
    if "z" in table:
        grades = np.abs(np.diff(table["z"])) / np.maximum(distances, 1e-9)
        k = int(np.argmax(grades))
        if grades[k] > 1.0:
            raise RoadFileError(
                f"{name} rises by {100.0 * grades[k]:.0f} % between points {k + 1} and {k + 2}; z must be in metres."
            )
    if "right" in table:
        _move_to_middle(table, course.closed, name)
    return table


def _move_to_middle(table: dict[str, Float], closed: bool, name: str) -> None:
    """Move points with widths to both edges to the middle between the edges."""
    right, left = table["right"], table["left"]
    for side, widths in (("right", right), ("left", left)):
        if (widths < 0.0).any():
            k = int(np.argmax(widths < 0.0))
            raise RoadFileError(
                f"{name}: the width {side} of point {k + 1} is {widths[k]:g} m; it must be 0 or more, from the line "
                "of the file to the edge."
            )
    points = np.stack([table["x"], table["y"]], axis=1)
    offset = 0.5 * (left - right)  # to the left
    curve, stations = curve_through(points, closed, name)
    tangents = curve(stations[: len(points)], 1)
    normal = np.stack([-tangents[:, 1], tangents[:, 0]], axis=1) / np.hypot(*tangents.T)[:, None]
    middle = points + offset[:, None] * normal
    reversal = (np.diff(points, axis=0) * np.diff(middle, axis=0)).sum(axis=1) <= 0.0
    if reversal.any():
        k = int(np.argmax(reversal))
        raise RoadFileError(
            f"{name}: with widths of {right[k]:g} m to the right and {left[k]:g} m to the left at point {k + 1} the "
            f"middle of the road turns back before point {k + 2}; widths must change slowly along it and be less than "
            "the radius of the line."
        )
    table["x"], table["y"] = middle.T
    if "bank" in table and "z" in table:
        table["z"] = table["z"] - table["bank"] * offset


def _grade_warning(layer: CourseLayer) -> str:
    """Sentence on the steepest point of a course that is steeper than `MAX_GRADE`, otherwise empty."""
    s = np.linspace(0.0, layer.line.length, len(layer.line.points))
    height = layer.height(s)
    grades = np.abs(np.diff(height)) / np.diff(s)
    k = int(np.argmax(grades))
    if grades[k] <= MAX_GRADE:
        return ""
    x, y, _ = layer.line.pose(s[k])
    return (
        f"The course '{layer.name}' climbs by {100.0 * grades[k]:.0f} % at station {s[k]:.0f} m, x = {x:.5g}, y = "
        f"{y:.5g}; it lies between {height.min():.4g} and {height.max():.4g} m. Roads have at most "
        f"{100.0 * MAX_GRADE:.0f} %: z must be heights in metres, not a width."
    )


def read_course(file: Path) -> dict[str, Float]:
    """Read the columns of a course file by name.

    `file`: CSV; its first line or a comment above it may name the columns by `COLUMNS`, by default they are the first
    of `DEFAULT_COLUMNS`. Raises `RoadFileError` if it is not such a file.
    """
    headings = {f"{name}{unit}" for name in COLUMNS for unit in ("", "_m")}
    table = TextTable(file, RoadFileError, headed=None, known=headings)
    if table.width > len(DEFAULT_COLUMNS) and not table.names:
        raise RoadFileError(
            f"{file} has {table.width} columns without names, which are {', '.join(DEFAULT_COLUMNS)} as far as there "
            f"are any; write a heading above them. Known are {KNOWN_COLUMNS}."
        )
    names = [_quantity_of(name) for name in table.names] or list(DEFAULT_COLUMNS[: table.width])
    if "" in names:
        raise RoadFileError(f"{file} has a column {brief(table.names[names.index('')])}; known are {KNOWN_COLUMNS}.")
    if not {"x", "y"} <= set(names) or len(set(names)) < len(names):
        raise RoadFileError(f"{file} must have a column x and a column y, each once, and no other twice.")
    if (sides := {"right", "left"} & set(names)) and (len(sides) < 2 or "width" in names):
        raise RoadFileError(f"{file} must have the widths right and left, both and no width beside them.")
    return dict(zip(names, table.values(least=0).T, strict=True))


def _quantity_of(heading: str) -> str:
    """Quantity of a column by its heading; empty: unknown, or not in metres."""
    name = re.sub("[ -]+", "_", heading.strip().lower())
    match = _HEADING_IN_METRES.fullmatch(name)
    return COLUMNS.get(match[1] if match and name != "bank_m" else name, "")


def _check_bounds(line: CentreLine, course: Course, bounds: tuple[float, float, float, float]) -> None:
    """Raise `RoadFileError` if a course leaves the world."""
    x0, y0, x1, y1 = bounds
    x, y = line.points.T
    outside = (x < x0) | (x > x1) | (y < y0) | (y > y1)
    if outside.any():
        k = int(np.argmax(outside))
        raise RoadFileError(
            f"The course '{course.name}' leaves the world at station {k * line.step:.0f} m, x = {x[k]:.6g}, y = "
            f"{y[k]:.6g}; the world reaches from ({x0:g}, {y0:g}) to ({x1:g}, {y1:g}) m."
        )


def _check_crossings(line: CentreLine, course: Course, width: Float) -> None:
    """Raise `RoadFileError` if a course crosses itself. `width`: width at each point of the line, m."""
    s = line.stations[:-1] if line.closed else line.stations
    points = line.points[: len(s)]
    pairs = cKDTree(points).query_pairs(0.9 * width.max(), output_type="ndarray")
    if len(pairs) == 0:
        return
    mean = 0.5 * (width[pairs[:, 0]] + width[pairs[:, 1]])
    close = np.hypot(*(points[pairs[:, 1]] - points[pairs[:, 0]]).T[:2]) < 0.9 * mean
    separation = np.abs(s[pairs[:, 1]] - s[pairs[:, 0]])
    if line.closed:
        separation = np.minimum(separation, line.length - separation)
    crossings = pairs[close & (separation > 3.2 * mean)]
    if len(crossings):
        a, b = crossings[0]
        raise RoadFileError(
            f"The course '{course.name}' crosses or touches itself at x = {points[a][0]:.5g}, y = {points[a][1]:.5g} "
            f"(stations {s[a]:.0f} and {s[b]:.0f} m); split it into courses, of which the later one lies on top."
        )


def _check_rising(stations: list[float], course: Course, key: str) -> None:
    """Raise `RoadFileError` if stations do not rise."""
    if any(b <= a for a, b in itertools.pairwise(stations)):
        raise RoadFileError(f"The stations of {key} of the course '{course.name}' do not rise: {stations}.")


def _at_stations(line: CentreLine, table: dict[str, Float]) -> dict[str, Float]:
    """Interpolate the columns of a file at the points of the line."""
    names = [name for name in ("z", "width", "bank") if name in table]
    if not names:
        return {}
    x, y = table["x"], table["y"]
    if line.closed and math.hypot(x[0] - x[-1], y[0] - y[-1]) > 1e-9:
        table = {name: np.append(values, values[0]) for name, values in table.items()}
        x, y = table["x"], table["y"]
    s = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
    return {name: np.interp(line.stations, s * line.length / s[-1], table[name]) for name in names}
