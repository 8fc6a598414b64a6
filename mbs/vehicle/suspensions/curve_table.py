"""Reads the table of an axle given by curves: a CSV file with units in its headings, as test rigs write it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from ali3.tables import TextTable
from mbs.model.smooth_table import MIN_POINTS, SPACING_TOLERANCE
from mbs.vehicle.car_files import car_file_path
from mbs.vehicle.errors import CarFileError

Array = NDArray[np.float64]

UNITS = {"m": ("m", 1.0), "mm": ("m", 1e-3), "rad": ("rad", 1.0), "deg": ("rad", math.pi / 180.0)}
WHEEL_TRAVEL, RACK, OTHER_TRAVEL = "wheel_travel", "rack_travel", "other_wheel_travel"
COLUMNS = {
    WHEEL_TRAVEL: "m",
    RACK: "m",
    OTHER_TRAVEL: "m",
    "wheel_centre_x": "m",
    "wheel_centre_y": "m",
    "contact_centre_x": "m",
    "contact_centre_y": "m",
    "wheelbase_change": "m",
    "track_change": "m",
    "toe_angle": "rad",
    "steer_angle": "rad",
    "camber_angle": "rad",
    "inclination_angle": "rad",
    "carrier_pitch_angle": "rad",
    "caster_angle": "rad",
    "spring_length": "m",
    "damper_length": "m",
    "anti_roll_bar_angle": "rad",
}
"""Columns of a table with their SI units."""
REQUIRED_GROUPS = (
    ("wheel_centre_x", "contact_centre_x", "wheelbase_change"),
    ("wheel_centre_y", "contact_centre_y", "track_change"),
    ("toe_angle", "steer_angle"),
    ("camber_angle", "inclination_angle"),
    ("carrier_pitch_angle", "caster_angle"),
)
"""Groups of columns of which one is required; the first one is used."""
OPTIONAL_COLUMNS = ("spring_length", "damper_length", "anti_roll_bar_angle")
MAX_ANGLE = 1.6  # rad
MAX_RATES = {"m": 1.0, "rad": 10.0}
"""Largest change per m of travel, by unit: a larger one is an error in a cell; twice as much for the track."""
RACK_FACTOR = 20.0  # on these rates, per travel of a rack
LEVER_FACTOR = 10.0  # on these rates, of springs, dampers and bars
POINT_TOLERANCE = 1e-9  # m, of equal points
MAX_INTERVALS = 200  # of a variable; a table with more is thinned
MAX_SPACINGS = {WHEEL_TRAVEL: 0.0125, RACK: 0.0065, OTHER_TRAVEL: 0.0125}  # m; a coarser table is interpolated


@dataclass(frozen=True)
class CurveTable:
    """Curves of the left wheel, or of both wheels, against one or two variables."""

    travel: Array
    """Travel of the left wheel centre, m, positive in bump, shape (n,); equidistant, with 0 among the points."""
    second: Array
    """Travel of the rack, positive to the left, or of the right wheel, m, shape (k,); k = 1 without a
    second variable."""
    second_name: str
    """`RACK`, `OTHER_TRAVEL` or empty."""
    columns: dict[str, Array]
    """Columns by name, SI units, shape (n, k) each."""
    unused_columns: tuple[str, ...] = ()
    """Columns of the file that are not used."""

    def of(self, name: str, side: str) -> Array | None:
        """Column of a wheel by its name with or, for the left wheel, without the side; None if there is none."""
        values = self.columns.get(f"{name}_{side}")
        return self.columns.get(name) if values is None and side == "left" else values

    @property
    def drawn(self) -> tuple[int, int]:
        """Indices of the drawing in both variables."""
        return int(np.argmin(np.abs(self.travel))), int(np.argmin(np.abs(self.second)))

    @property
    def has_right_wheel(self) -> bool:
        """Whether the right wheel has columns of its own."""
        return any(name.endswith("_right") for name in self.columns)

    def exchanged(self) -> CurveTable:
        """Copy of the table with both variables exchanged."""
        columns = {name: values.T for name, values in self.columns.items()}
        return replace(self, travel=self.second, second=self.travel, columns=columns)


def read_curves(folder: Path, name: str, key: str, size: float) -> CurveTable:
    """Read the table of an axle.

    `key`: key path of the name, for messages; `size`: size of the axle, m, the largest change of positions and lengths.

    Raises `CarFileError` if there is no such file, or it is not such a table.
    """
    what = f"{key} ({name})"
    table = TextTable(
        car_file_path(folder, name, key), CarFileError, what, known=(WHEEL_TRAVEL, f"{WHEEL_TRAVEL}_left"), units=True
    )
    file_columns = dict(zip(table.names, table.values(finite=False).T, strict=True))
    used = [n for n in file_columns if n in COLUMNS or (_base(n) in COLUMNS and _base(n) not in (RACK, OTHER_TRAVEL))]
    columns = {n: _in_si(what, n, table.units.get(n, ""), file_columns[n], size) for n in used}
    travel = _travel(what, file_columns, columns)
    seconds = [n for n in (RACK, OTHER_TRAVEL) if n in columns]
    if len(seconds) > 1:
        raise CarFileError(f"{what} has the columns {RACK} and {OTHER_TRAVEL}; give at most one of them.")
    _check_sides(what, file_columns, columns)
    second_name = seconds[0] if seconds else ""
    curves = _grid(what, travel, columns.pop(second_name, None), second_name, columns)
    _check_rates(what, curves)
    return replace(curves, unused_columns=tuple(n for n in file_columns if n not in used))


def _base(name: str) -> str:
    """Name of a column without its side."""
    return name.removesuffix("_left").removesuffix("_right")


def _travel(what: str, file_columns: Iterable[str], columns: dict[str, Array]) -> Array:
    """Remove the travel of both wheels, or of the left one, from the columns and return it."""
    names = [n for n in (WHEEL_TRAVEL, f"{WHEEL_TRAVEL}_left", f"{WHEEL_TRAVEL}_right") if n in columns]
    if names in ([], [f"{WHEEL_TRAVEL}_right"]):
        raise CarFileError(f"{what} has no column {WHEEL_TRAVEL}; its columns are {', '.join(file_columns)}.")
    travel = columns.pop(names[0])
    for name in names[1:]:
        values = columns.pop(name)
        different = np.abs(values - travel) > POINT_TOLERANCE
        if np.any(different):
            k = int(np.argmax(different))
            raise CarFileError(
                f"{what}, row {k + 1} has a {names[0]} of {travel[k]:g} m and a {name} of {values[k]:g} m; both wheels "
                f"must travel alike, or give {OTHER_TRAVEL} instead of {name}."
            )
    return travel


def _check_sides(what: str, file_columns: Iterable[str], columns: Mapping[str, Array]) -> None:
    """Raise `CarFileError` if a required column is missing; both wheels need one if the right wheel has any."""
    both = any(n.endswith("_right") for n in columns)
    for names in REQUIRED_GROUPS:
        for side in ("left", "right") if both else ("left",):
            if not any(f"{n}_{side}" in columns or (side == "left" and n in columns) for n in names):
                raise CarFileError(
                    f"{what} has no column {' or '.join(names)}{f' of the {side} wheel' if both else ''}; "
                    f"its columns are {', '.join(file_columns)}."
                )
    for name in OPTIONAL_COLUMNS if both else ():
        present = [n for n in (name, f"{name}_left", f"{name}_right") if n in columns]
        pair = [f"{name}_left", f"{name}_right"]
        if present and present != pair:
            raise CarFileError(
                f"{what} has columns of the right wheel and {', '.join(present)}; there must be {' and '.join(pair)}, "
                "or neither."
            )


def _in_si(what: str, name: str, unit: str, values: Array, size: float) -> Array:
    """Convert a column to SI units. Raises `CarFileError` if its unit or its values are not valid."""
    base = _base(name)
    available = [u for u, (si, _) in UNITS.items() if si == COLUMNS[base]]
    if unit not in available:
        raise CarFileError(
            f"{what} has the heading '{f'{name} [{unit}]' if unit else name}'; it must be '{name} [UNIT]' with "
            f"{' or '.join(available)}."
        )
    si_values = values * UNITS[unit][1]
    if COLUMNS[base] == "m":  # the origin may belong to a test rig
        if not (change := float(np.ptp(si_values))) <= size:
            raise CarFileError(
                f"{what}, column {name} changes by {change:g} m from its least to its largest value; it must be less "
                f"than {size:.3g} m, the way from the middle of the axle on the ground to the wheel centre."
            )
    elif not (largest := float(np.max(np.abs(si_values), initial=0.0))) <= MAX_ANGLE:
        raise CarFileError(f"{what}, column {name} reaches {largest:g} rad; it must be within {MAX_ANGLE:g} rad.")
    return np.asarray(si_values)


def _grid(what: str, travel: Array, second: Array | None, second_name: str, columns: Mapping[str, Array]) -> CurveTable:
    """Make the table at equidistant points from the rows of a file."""
    if second is None:
        if len(_distinct_points(travel)) < len(travel):
            raise CarFileError(
                f"{what} has values of {WHEEL_TRAVEL} twice, and no second column of travels beside it: {RACK} where "
                f"the axle steers, {OTHER_TRAVEL} where its wheels move each other."
            )
        _check_axis(what, WHEEL_TRAVEL, travel)
        points = _equidistant(travel, MAX_SPACINGS[WHEEL_TRAVEL])
        return CurveTable(
            points, np.zeros(1), "", {n: _resample(travel, points, v[:, None], 0) for n, v in columns.items()}
        )
    along, across = _distinct_points(travel), _distinct_points(second)
    for name, points in ((WHEEL_TRAVEL, along), (second_name, across)):
        _check_axis(what, name, points)
    travel_index, second_index = (np.searchsorted(p, v, "right") - 1 for p, v in ((along, travel), (across, second)))
    pairs = travel_index * len(across) + second_index
    if len(np.unique(pairs)) < len(pairs):
        raise CarFileError(
            f"{what} has a pair of {WHEEL_TRAVEL} and {second_name} twice; there must be one row for each."
        )
    i, k = int(np.argmin(np.abs(along))), int(np.argmin(np.abs(across)))
    has_drawing = abs(along[i]) < POINT_TOLERANCE and abs(across[k]) < POINT_TOLERANCE
    is_cross = (
        has_drawing
        and len(pairs) == len(along) + len(across) - 1
        and bool(np.all((travel_index == i) | (second_index == k)))
    )
    size = len(along) * len(across)
    if len(pairs) < size and not (is_cross and second_name == RACK):
        raise CarFileError(
            f"{what} has {len(travel)} rows for {len(along)} values of {WHEEL_TRAVEL} and {len(across)} of "
            f"{second_name}; there must be one for each pair, {size}, or of a rack those where one of both is 0."
        )
    order = np.argsort(pairs)
    # rows of the two curves through the drawing
    travel_rows, other_rows = order[second_index[order] == k], order[travel_index[order] == i]
    axes, resampled = (
        (_equidistant(along, MAX_SPACINGS[WHEEL_TRAVEL]), _equidistant(across, MAX_SPACINGS[second_name])),
        {},
    )
    for name, values in columns.items():
        if is_cross:
            changes = _resample(across, axes[1], values[other_rows][None] - values[travel_rows[i]], 1)
            resampled[name] = _resample(along, axes[0], values[travel_rows][:, None], 0) + changes
        else:
            grid = values[order].reshape(len(along), len(across))
            resampled[name] = _resample(across, axes[1], _resample(along, axes[0], grid, 0), 1)
    return CurveTable(*axes, second_name, resampled)


def _check_rates(what: str, table: CurveTable) -> None:
    """Raise `CarFileError` if a column changes too fast between neighbouring points."""
    for axis, (name, points) in enumerate(((WHEEL_TRAVEL, table.travel), (table.second_name, table.second))):
        for column, values in table.columns.items() if len(points) > 1 else ():
            unit, rates = COLUMNS[_base(column)], np.abs(np.diff(values, axis=axis)) / np.diff(points).mean()
            largest_rate = MAX_RATES[unit] * (RACK_FACTOR if name == RACK else 1.0)
            if _base(column) in OPTIONAL_COLUMNS:
                largest_rate *= LEVER_FACTOR
            if _base(column) == "track_change":
                largest_rate *= 2.0
            if rates.max() > largest_rate:
                location = points[np.unravel_index(np.argmax(rates), rates.shape)[axis]]
                raise CarFileError(
                    f"{what}, column {column} changes by {rates.max():.3g} {unit} per m of {name} near a {name} of "
                    f"{location:.3g} m; at most {largest_rate:g} {unit}/m is taken for a motion."
                )


def _distinct_points(values: Array) -> Array:
    """Distinct values in ascending order; of equal ones the least."""
    distinct = np.unique(values)
    return np.asarray(distinct[np.concatenate([[True], np.diff(distinct) > POINT_TOLERANCE])])


def _check_axis(what: str, name: str, points: Array) -> None:
    """Raise `CarFileError` if the points of a variable do not rise, are too few, or do not enclose 0."""
    steps = np.diff(points)
    if len(points) < MIN_POINTS:
        raise CarFileError(f"{what} has {len(points)} values of {name}; there must be {MIN_POINTS} or more.")
    if not np.all(steps > POINT_TOLERANCE):
        k = int(np.argmin(steps > POINT_TOLERANCE))
        raise CarFileError(f"{what} has a {name} of {points[k + 1]:g} m after {points[k]:g} m; it must rise.")
    if not points[0] < 0.0 < points[-1]:
        raise CarFileError(
            f"{what} has {name} from {points[0]:g} to {points[-1]:g} m; 0, the drawing, must lie between them."
        )
    if min(-points[0], points[-1]) < (points[-1] - points[0]) / MAX_INTERVALS:
        raise CarFileError(
            f"{what} has {name} from {points[0]:g} to {points[-1]:g} m; both ends must be farther from 0 than a "
            f"{MAX_INTERVALS}th of the range."
        )


def _equidistant(points: Array, largest_spacing: float) -> Array:
    """Equidistant points in the range of the given ones, with 0 among them, about as dense as their densest part.

    Columns are interpolated by splines at these points before positions and rotations are computed.
    """
    steps = np.diff(points)
    zero = int(np.argmin(np.abs(points)))
    if (
        np.ptp(steps) <= SPACING_TOLERANCE * steps.max()
        and abs(points[zero]) < POINT_TOLERANCE
        and len(steps) <= MAX_INTERVALS
    ):
        count = math.ceil(steps.max() / largest_spacing)
        step = steps.mean() / count
        return points if count == 1 else step * np.arange(-zero * count, (len(points) - 1 - zero) * count + 1)
    span = points[-1] - points[0]
    step = max(min(float(steps.min()), largest_spacing), span / MAX_INTERVALS, POINT_TOLERANCE)
    step = -points[0] / max(1, round(-points[0] / step))
    low, high = round(-points[0] / step), math.floor(points[-1] / step + 1e-9)
    while low + high + 1 < MIN_POINTS or high < 1:
        step *= 0.5
        low, high = 2 * low, math.floor(points[-1] / step + 1e-9)
    return np.asarray(step * np.arange(-low, high + 1), float)


def _resample(points: Array, new_points: Array, values: Array, axis: int) -> Array:
    """Values interpolated along an axis by a cubic spline."""
    if len(points) == len(new_points) and np.max(np.abs(points - new_points)) < POINT_TOLERANCE:
        return values
    return np.asarray(CubicSpline(points, values, axis=axis)(new_points))
