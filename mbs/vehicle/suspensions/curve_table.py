"""The table of an axle by its curves: a CSV file with units in its headings, as rigs and multibody programs give it."""

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
from mbs.vehicle.errors import CarFileError
from mbs.vehicle.files import beside

Array = NDArray[np.float64]

UNITS = {"m": ("m", 1.0), "mm": ("m", 1e-3), "rad": ("rad", 1.0), "deg": ("rad", math.pi / 180.0)}
TRAVEL, RACK, OTHER = "wheel_travel", "rack_travel", "other_wheel_travel"
COLUMNS = {
    TRAVEL: "m",
    RACK: "m",
    OTHER: "m",
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
"""What a table may have, with the unit that is computed in."""
NEEDED = (
    ("wheel_centre_x", "contact_centre_x", "wheelbase_change"),
    ("wheel_centre_y", "contact_centre_y", "track_change"),
    ("toe_angle", "steer_angle"),
    ("camber_angle", "inclination_angle"),
    ("carrier_pitch_angle", "caster_angle"),
)
"""Of each line there must be one; the first that is there is used."""
OPTIONAL = ("spring_length", "damper_length", "anti_roll_bar_angle")
LARGEST = 1.6  # rad
STEEPEST = {"m": 1.0, "rad": 10.0}
"""Per m of travel; more is no motion of a wheel but a wrong cell. Of both wheels together twice as much."""
GEARED, LEVERED = 20.0, 10.0  # times as much over the travel of a rack; in springs and bars
SAME = 1e-9  # m: two places of a table that are one
FINEST = 200  # parts of a coordinate; a table with more is thinned
COARSEST = {TRAVEL: 0.0125, RACK: 0.0065, OTHER: 0.0125}  # m: a table with farther points gets some between them


@dataclass(frozen=True)
class CurveTable:
    """A table of the left wheel as it stands in the file, or of both."""

    travel: Array
    """Shape (n,): of the left wheel's centre, m, positive in bump; evenly spaced, with 0 among the points."""
    second: Array
    """Shape (k,): travel of the rack, positive to the left, or of the right wheel, m, likewise; one point where there
    is none."""
    second_name: str
    """`RACK`, `OTHER` or nothing."""
    columns: dict[str, Array]
    """By name, each of shape (n, k), SI units."""
    left_out: tuple[str, ...] = ()
    """Columns of the file that are not used."""

    def of(self, name: str, side: str) -> Array | None:
        """A column of a wheel: with the side behind its name, or without, which is of the left wheel."""
        values = self.columns.get(f"{name}_{side}")
        return self.columns.get(name) if values is None and side == "left" else values

    @property
    def both(self) -> bool:
        """Whether the right wheel has columns of its own."""
        return any(name.endswith("_right") for name in self.columns)

    def exchanged(self) -> CurveTable:
        """Copy of the table with both variables exchanged."""
        columns = {name: values.T for name, values in self.columns.items()}
        return replace(self, travel=self.second, second=self.travel, columns=columns)


def read_curves(folder: Path, name: str, key: str, size: float) -> CurveTable:
    """Read the table of an axle.

    `key`: key path of the name, for messages; `size`: of the axle, m: no place or length of it changes by more.

    Raises `CarFileError`: there is no such file, or it is no such table; the message says what is missing.
    """
    what = f"{key} ({name})"
    table = TextTable(beside(folder, name, key), CarFileError, what, known=(TRAVEL, f"{TRAVEL}_left"), units=True)
    file_columns = dict(zip(table.names, table.values(finite=False).T, strict=True))
    used = [n for n in file_columns if n in COLUMNS or (_base(n) in COLUMNS and _base(n) not in (RACK, OTHER))]
    columns = {n: _in_si(what, n, table.units.get(n, ""), file_columns[n], size) for n in used}
    travel = _travel(what, file_columns, columns)
    seconds = [n for n in (RACK, OTHER) if n in columns]
    if len(seconds) > 1:
        raise CarFileError(f"{what} has the columns {RACK} and {OTHER}; give at most one of them.")
    _check_sides(what, file_columns, columns)
    second_name = seconds[0] if seconds else ""
    curves = _grid(what, travel, columns.pop(second_name, None), second_name, columns)
    _check_rates(what, curves)
    return replace(curves, left_out=tuple(n for n in file_columns if n not in used))


def _base(name: str) -> str:
    """A name without its side."""
    return name.removesuffix("_left").removesuffix("_right")


def _travel(what: str, given: Iterable[str], columns: dict[str, Array]) -> Array:
    """The travel of both wheels, or of the left one beside that of the other, taken out of the columns."""
    names = [n for n in (TRAVEL, f"{TRAVEL}_left", f"{TRAVEL}_right") if n in columns]
    if names in ([], [f"{TRAVEL}_right"]):
        raise CarFileError(f"{what} has no column {TRAVEL}; its columns are {', '.join(given)}.")
    travel = columns.pop(names[0])
    for name in names[1:]:
        values = columns.pop(name)
        apart = np.abs(values - travel) > SAME
        if np.any(apart):
            k = int(np.argmax(apart))
            raise CarFileError(
                f"{what}, row {k + 1} has a {names[0]} of {travel[k]:g} m and a {name} of {values[k]:g} m; both wheels "
                f"must travel alike, or give {OTHER} in place of {name}."
            )
    return travel


def _check_sides(what: str, file_columns: Iterable[str], columns: Mapping[str, Array]) -> None:
    """Check that the needed columns are there, for both wheels if the right wheel has a column of its own."""
    both = any(n.endswith("_right") for n in columns)
    for names in NEEDED:
        for side in ("left", "right") if both else ("left",):
            if not any(f"{n}_{side}" in columns or (side == "left" and n in columns) for n in names):
                raise CarFileError(
                    f"{what} has no column {' or '.join(names)}{f' of the {side} wheel' if both else ''}; "
                    f"its columns are {', '.join(file_columns)}."
                )
    for name in OPTIONAL if both else ():
        present = [n for n in (name, f"{name}_left", f"{name}_right") if n in columns]
        pair = [f"{name}_left", f"{name}_right"]
        if present and present != pair:
            raise CarFileError(
                f"{what} has columns of the right wheel and {', '.join(present)}; there must be {' and '.join(pair)}, "
                "or neither."
            )


def _in_si(what: str, name: str, unit: str, values: Array, size: float) -> Array:
    base = _base(name)
    available = [u for u, (si, _) in UNITS.items() if si == COLUMNS[base]]
    if unit not in available:
        raise CarFileError(
            f"{what} has the heading '{f'{name} [{unit}]' if unit else name}'; it must be '{name} [UNIT]' with "
            f"{' or '.join(available)}."
        )
    si_values = values * UNITS[unit][1]
    if COLUMNS[base] == "m":  # whose origin is that of the rig
        if not (change := float(np.ptp(si_values))) <= size:
            raise CarFileError(
                f"{what}, column {name} changes by {change:g} m from its least to its largest value; it must be less "
                f"than {size:.3g} m, the way from the middle of the axle on the ground to the wheel centre."
            )
    elif not (largest := float(np.max(np.abs(si_values), initial=0.0))) <= LARGEST:
        raise CarFileError(f"{what}, column {name} reaches {largest:g} rad; it must be within {LARGEST:g} rad.")
    return np.asarray(si_values)


def _grid(what: str, travel: Array, second: Array | None, second_name: str, columns: Mapping[str, Array]) -> CurveTable:
    """Rows as a table over evenly spaced points."""
    if second is None:
        if len(_points(travel)) < len(travel):
            raise CarFileError(
                f"{what} has values of {TRAVEL} twice, and no second column of travels beside it: {RACK} where the "
                f"axle steers, {OTHER} where its wheels move each other."
            )
        _check_axis(what, TRAVEL, travel)
        even = _even(travel, COARSEST[TRAVEL])
        return CurveTable(
            even, np.zeros(1), "", {n: _resampled(travel, even, v[:, None], 0) for n, v in columns.items()}
        )
    along, across = _points(travel), _points(second)
    for name, points in ((TRAVEL, along), (second_name, across)):
        _check_axis(what, name, points)
    place, at = (np.searchsorted(p, v, "right") - 1 for p, v in ((along, travel), (across, second)))
    pairs = place * len(across) + at
    if len(np.unique(pairs)) < len(pairs):
        raise CarFileError(f"{what} has a pair of {TRAVEL} and {second_name} twice; there must be one row for each.")
    i, k = int(np.argmin(np.abs(along))), int(np.argmin(np.abs(across)))
    drawn = abs(along[i]) < SAME and abs(across[k]) < SAME
    cross = drawn and len(pairs) == len(along) + len(across) - 1 and bool(np.all((place == i) | (at == k)))
    size = len(along) * len(across)
    if len(pairs) < size and not (cross and second_name == RACK):
        raise CarFileError(
            f"{what} has {len(travel)} rows for {len(along)} values of {TRAVEL} and {len(across)} of {second_name}; "
            f"there must be one for each pair, {size}, or of a rack those where one of both is 0."
        )
    order = np.argsort(pairs)
    travel_rows, other_rows = order[at[order] == k], order[place[order] == i]  # rows of both sweeps through the drawing
    evens, resampled = (_even(along, COARSEST[TRAVEL]), _even(across, COARSEST[second_name])), {}
    for name, values in columns.items():
        if cross:
            changes = _resampled(across, evens[1], values[other_rows][None] - values[travel_rows[i]], 1)
            resampled[name] = _resampled(along, evens[0], values[travel_rows][:, None], 0) + changes
        else:
            grid = values[order].reshape(len(along), len(across))
            resampled[name] = _resampled(across, evens[1], _resampled(along, evens[0], grid, 0), 1)
    return CurveTable(*evens, second_name, resampled)


def _check_rates(what: str, table: CurveTable) -> None:
    """No place or angle of a wheel jumps from one point of the table to the next."""
    for axis, (name, points) in enumerate(((TRAVEL, table.travel), (table.second_name, table.second))):
        for column, values in table.columns.items() if len(points) > 1 else ():
            unit, rates = COLUMNS[_base(column)], np.abs(np.diff(values, axis=axis)) / np.diff(points).mean()
            steepest = STEEPEST[unit] * (GEARED if name == RACK else 1.0)
            if _base(column) in OPTIONAL:
                steepest *= LEVERED
            if _base(column) == "track_change":
                steepest *= 2.0
            if rates.max() > steepest:
                at = points[np.unravel_index(np.argmax(rates), rates.shape)[axis]]
                raise CarFileError(
                    f"{what}, column {column} changes by {rates.max():.3g} {unit} per m of {name} near a {name} of "
                    f"{at:.3g} m; at most {steepest:g} {unit}/m is taken for a motion."
                )


def _points(values: Array) -> Array:
    """Different values, rising; of those that are one, the least."""
    distinct = np.unique(values)
    return np.asarray(distinct[np.concatenate([[True], np.diff(distinct) > SAME])])


def _check_axis(what: str, name: str, points: Array) -> None:
    steps = np.diff(points)
    if len(points) < MIN_POINTS:
        raise CarFileError(f"{what} has {len(points)} values of {name}; there must be {MIN_POINTS} or more.")
    if not np.all(steps > SAME):
        k = int(np.argmin(steps > SAME))
        raise CarFileError(f"{what} has a {name} of {points[k + 1]:g} m after {points[k]:g} m; it must rise.")
    if not points[0] < 0.0 < points[-1]:
        raise CarFileError(
            f"{what} has {name} from {points[0]:g} to {points[-1]:g} m; 0, the drawing, must lie between them."
        )
    if min(-points[0], points[-1]) < (points[-1] - points[0]) / FINEST:
        raise CarFileError(
            f"{what} has {name} from {points[0]:g} to {points[-1]:g} m; both ends must be farther from 0 than a "
            f"{FINEST}th of the range."
        )


def _even(points: Array, coarsest: float) -> Array:
    """The points, or evenly spaced ones within them, at most as dense as they are at their densest, with 0 among them.

    Places and rotations are splines through these points, angles of coarse ones are splines before.
    """
    steps = np.diff(points)
    zero = int(np.argmin(np.abs(points)))
    if np.ptp(steps) <= SPACING_TOLERANCE * steps.max() and abs(points[zero]) < SAME and len(steps) <= FINEST:
        count = math.ceil(steps.max() / coarsest)
        step = steps.mean() / count
        return points if count == 1 else step * np.arange(-zero * count, (len(points) - 1 - zero) * count + 1)
    span = points[-1] - points[0]
    step = max(min(float(steps.min()), coarsest), span / FINEST, SAME)
    step = -points[0] / max(1, round(-points[0] / step))
    low, high = round(-points[0] / step), math.floor(points[-1] / step + 1e-9)
    while low + high + 1 < MIN_POINTS or high < 1:
        step *= 0.5
        low, high = 2 * low, math.floor(points[-1] / step + 1e-9)
    return np.asarray(step * np.arange(-low, high + 1), float)


def _resampled(points: Array, even: Array, values: Array, axis: int) -> Array:
    if len(points) == len(even) and np.max(np.abs(points - even)) < SAME:
        return values
    return np.asarray(CubicSpline(points, values, axis=axis)(even))
