"""Computes the curves of an axle from its links, as a table that `kind = "curves"` reads."""

import csv
from os import PathLike
from pathlib import Path

import numpy as np

from ali3.files import atomic_file
from mbs.vehicle.linkages.linkage import Array, Linkage, NotReachedError
from mbs.vehicle.linkages.pose_grid import MARGIN, SPACING, compression_range, even_points, is_coupled
from mbs.vehicle.suspensions.curve_poses import axes_of
from mbs.vehicle.suspensions.curve_table import COLUMNS, OTHER, RACK, TRAVEL


def curve_rows(linkage: Linkage, rack_travel: float) -> dict[str, Array]:
    """Columns of the table of the left wheel over its travel between the stops, (n,) each, by name, SI units.

    `rack_travel`: to each side, m; 0: the axle is not steered. Raises `NotReachedError`: the links cannot follow as far
    as the stops.
    """
    coupled = is_coupled(linkage)
    travel = _travels(linkage, coupled)
    name, second = "", np.zeros(1)
    if coupled:
        name, second = OTHER, travel
    elif linkage.has_rod and rack_travel > 0.0:
        name, second = RACK, even_points(-rack_travel - MARGIN, rack_travel + MARGIN, SPACING[1])
    rows: list[dict[str, float]] = []
    for t in travel:
        for u in second:
            position = (np.array([t, u]), 0.0) if coupled else (np.array([t, t]), float(u))
            q = _reached(linkage, *position)
            rows.append({TRAVEL: float(t), **({name: float(u)} if name else {}), **_measures(linkage, q)})
    return {column: np.array([row[column] for row in rows]) + 0.0 for column in rows[0]}


def write_curve_table(linkage: Linkage, rack_travel: float, file: str | PathLike[str]) -> None:
    """Write `curve_rows` as CSV, with units in the heading; an older file is replaced when the new one is whole."""
    columns = curve_rows(linkage, rack_travel)
    with atomic_file(Path(file)) as target, target.open("w", newline="", encoding="utf-8") as out:
        writer = csv.writer(out, lineterminator="\n")
        writer.writerow([f"{name} [{COLUMNS[name]}]" for name in columns])
        writer.writerows(np.column_stack(list(columns.values())).tolist())


def _travels(linkage: Linkage, coupled: bool) -> Array:
    """Travels (n,) of a wheel, m, from beyond one stop to beyond the other at any position of the other wheel."""
    extended, compressed = compression_range(linkage)
    limits = []
    for direction, most in ((-1.0, extended), (1.0, compressed)):
        t = 0.0
        directions = (1.0, -1.0) if coupled else (1.0,)
        while (
            min(direction * _compression(linkage, _reached(linkage, np.array([t, o * t]), 0.0)) for o in directions)
            < most
        ):
            t += direction * 0.5 * SPACING[0]
        limits.append(t)
    return even_points(limits[0], limits[1], SPACING[0])


def _compression(linkage: Linkage, q: Array) -> float:
    D, d = linkage.linear(linkage.springs[0])
    return float(np.linalg.norm(D @ linkage.drawn.q + d) - np.linalg.norm(D @ q + d))


def _reached(linkage: Linkage, travel: Array, rack: float) -> Array:
    """Coordinates at a position, solved in 1, 4, 16 or 64 steps from the drawing."""
    for step_count in (1, 4, 16, 64):
        at = linkage.drawn
        try:
            for k in range(step_count):
                share = (k + 1) / step_count
                at = linkage.solve(at.q, share * travel, share * rack)
        except NotReachedError:
            continue
        return at.q
    return linkage.solve(linkage.drawn.q, travel, rack).q


def _measures(linkage: Linkage, q: Array) -> dict[str, float]:
    """Values of the columns of the left wheel at coordinates q, m and rad."""
    C, c = linkage.centre(0)
    (x, y, _), triad = C @ q + c, [A @ q + a for A, a in linkage.triad(0)]
    axis = triad[1]
    steer, inclination = np.arctan2(-axis[0], axis[1]), np.arcsin(axis[2])
    level = axes_of(steer, inclination)
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
