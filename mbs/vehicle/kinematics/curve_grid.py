"""Computes the curves of an axle from its links as a table for `kind = "curves"`."""

from os import PathLike

import numpy as np

from mbs.vehicle.kinematics.curve_files import write_columns
from mbs.vehicle.kinematics.wheel_motion import wheel_motion
from mbs.vehicle.linkages.linkage import Array, Linkage, NotReachedError, Position
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
            second = {name: float(u)} if name else {}
            rows.append({WHEEL_TRAVEL: float(t), **second, **_columns_at(linkage, _solve(linkage, *position))})
    return {column: np.array([row[column] for row in rows]) + 0.0 for column in rows[0]}


def write_curve_table(linkage: Linkage, rack_travel: float, file: str | PathLike[str]) -> None:
    """Write `curve_rows` as CSV with units in the headings, completely or not at all."""
    columns = curve_rows(linkage, rack_travel)
    write_columns(file, columns, {name: COLUMNS[name] for name in columns})


def _wheel_travels(linkage: Linkage, coupled: bool) -> Array:
    """Travels of a wheel from beyond one stop to beyond the other, at any travel of the other wheel, m, shape (n,)."""
    extended, compressed = compression_range(linkage)
    spring = linkage.springs[0]
    drawn_length = linkage.length(spring, linkage.drawn.q)[0]

    def compression(left: float, right: float) -> float:
        return drawn_length - linkage.length(spring, _solve(linkage, np.array([left, right]), 0.0).q)[0]

    limits = []
    for direction, limit in ((-1.0, extended), (1.0, compressed)):
        t = 0.0
        directions = (1.0, -1.0) if coupled else (1.0,)
        while min(direction * compression(t, o * t) for o in directions) < limit:
            t += direction * 0.5 * SPACING[0]
        limits.append(t)
    return even_points(limits[0], limits[1], SPACING[0])


def _solve(linkage: Linkage, travel: Array, rack: float) -> Position:
    """Position at travels of wheels and rack, m, solved in 1, 4, 16 or 64 steps from the drawing."""
    for step_count in (1, 4, 16, 64):
        position = linkage.drawn
        try:
            for k in range(step_count):
                fraction = (k + 1) / step_count
                position = linkage.solve(position.q, fraction * travel, fraction * rack)
        except NotReachedError:
            continue
        return position
    return linkage.solve(linkage.drawn.q, travel, rack)


def _columns_at(linkage: Linkage, position: Position) -> dict[str, float]:
    """Values of the columns of the left wheel at a position, SI units."""
    wheel, (A, a) = wheel_motion(linkage, position, 0), linkage.triad(0)[0]
    forward, level = A @ position.q + a, wheel_axes(np.array(wheel.steer), np.array(wheel.inclination))
    measures = {
        "wheel_centre_x": float(wheel.centre[0]),
        "wheel_centre_y": float(wheel.centre[1]),
        "toe_angle": -wheel.steer,
        "camber_angle": -wheel.inclination,
        "carrier_pitch_angle": -float(np.arctan2(forward @ level[:, 2], forward @ level[:, 0])),
    }
    lines = {"spring_length": linkage.springs[0], "damper_length": linkage.dampers[0]}
    if linkage.dampers[0] == linkage.springs[0]:
        del lines["damper_length"]  # one with the spring
    measures |= {name: linkage.length(line, position.q)[0] for name, line in lines.items()}
    if linkage.levers:
        row, constant = linkage.full(linkage.levers[0])
        measures["anti_roll_bar_angle"] = float(row @ position.q + constant)
    return measures
