"""Computes the curves of an axle from its links as a table for `kind = "curves"`."""

import csv
from os import PathLike
from pathlib import Path

import numpy as np

from ali3.files import atomic_file
from mbs.vehicle.linkages.linkage import Array, Linkage, NotReachedError
from mbs.vehicle.linkages.pose_grid import MARGIN, SPACING, compression_range, even_points, is_coupled
from mbs.vehicle.suspensions.curve_poses import wheel_axes
from mbs.vehicle.suspensions.curve_table import COLUMNS, OTHER_TRAVEL, RACK, WHEEL_TRAVEL


def curve_rows(linkage: Linkage, rack_travel: float) -> dict[str, Array]:
    """Compute the columns of the table of the left wheel between its stops by name, SI units, shape (n,) each.

    `rack_travel`: travel to each side, m; 0: the axle is not steered. Raises `NotReachedError` if the links cannot
    reach the stops.
    """
    coupled = is_coupled(linkage)
    travel = _wheel_travels(linkage, coupled)
    name, second_values = "", np.zeros(1)
    if coupled:
        name, second_values = OTHER_TRAVEL, travel
    elif linkage.has_rod and rack_travel > 0.0:
        name, second_values = RACK, even_points(-rack_travel - MARGIN, rack_travel + MARGIN, SPACING[1])
    rows: list[dict[str, float]] = []
    for t in travel:
        for u in second_values:
            position = (np.array([t, u]), 0.0) if coupled else (np.array([t, t]), float(u))
            q = _solve(linkage, *position)
            rows.append({WHEEL_TRAVEL: float(t), **({name: float(u)} if name else {}), **_columns_at(linkage, q)})
    return {column: np.array([row[column] for row in rows]) + 0.0 for column in rows[0]}


def write_curve_table(linkage: Linkage, rack_travel: float, file: str | PathLike[str]) -> None:
    """Write `curve_rows` as CSV with units in the headings, completely or not at all."""
    columns = curve_rows(linkage, rack_travel)
    with atomic_file(Path(file)) as target, target.open("w", newline="", encoding="utf-8") as out:
        writer = csv.writer(out, lineterminator="\n")
        writer.writerow([f"{name} [{COLUMNS[name]}]" for name in columns])
        writer.writerows(np.column_stack(list(columns.values())).tolist())


def _wheel_travels(linkage: Linkage, coupled: bool) -> Array:
    """Travels of a wheel from beyond one stop to beyond the other, at any travel of the other wheel, m, shape (n,)."""
    extended, compressed = compression_range(linkage)
    limits = []
    for direction, limit in ((-1.0, extended), (1.0, compressed)):
        t = 0.0
        directions = (1.0, -1.0) if coupled else (1.0,)
        while (
            min(direction * _left_compression(linkage, _solve(linkage, np.array([t, o * t]), 0.0)) for o in directions)
            < limit
        ):
            t += direction * 0.5 * SPACING[0]
        limits.append(t)
    return even_points(limits[0], limits[1], SPACING[0])


def _left_compression(linkage: Linkage, q: Array) -> float:
    """Compression of the left spring from the drawing at coordinates q, m."""
    D, d = linkage.linear(linkage.springs[0])
    return float(np.linalg.norm(D @ linkage.drawn.q + d) - np.linalg.norm(D @ q + d))


def _solve(linkage: Linkage, travel: Array, rack: float) -> Array:
    """Coordinates at a position (nq,), solved in 1, 4, 16 or 64 steps from the drawing."""
    for step_count in (1, 4, 16, 64):
        position = linkage.drawn
        try:
            for k in range(step_count):
                fraction = (k + 1) / step_count
                position = linkage.solve(position.q, fraction * travel, fraction * rack)
        except NotReachedError:
            continue
        return position.q
    return linkage.solve(linkage.drawn.q, travel, rack).q


def _columns_at(linkage: Linkage, q: Array) -> dict[str, float]:
    """Values of the columns of the left wheel at coordinates q, SI units."""
    C, c = linkage.centre(0)
    (x, y, _), triad = C @ q + c, [A @ q + a for A, a in linkage.triad(0)]
    axis = triad[1]
    steer, inclination = np.arctan2(-axis[0], axis[1]), np.arcsin(axis[2])
    level = wheel_axes(steer, inclination)
    measures = {
        "wheel_centre_x": float(x),
        "wheel_centre_y": float(y),
        "toe_angle": -float(steer),
        "camber_angle": -float(inclination),
        "carrier_pitch_angle": -float(np.arctan2(triad[0] @ level[:, 2], triad[0] @ level[:, 0])),
    }
    for name, lines in (("spring_length", linkage.springs), ("damper_length", linkage.dampers)):
        D, d = linkage.linear(lines[0])
        measures[name] = float(np.linalg.norm(D @ q + d))
    if linkage.dampers[0] == linkage.springs[0]:
        del measures["damper_length"]  # one with the spring
    if linkage.levers:
        row, constant = linkage.full(linkage.levers[0])
        measures["anti_roll_bar_angle"] = float(row @ q + constant)
    return measures
