"""Positions and rotations of a wheel carrier from the columns of its table."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mbs.vehicle.side import Point, Side
from mbs.vehicle.suspensions.curve_table import OTHER_TRAVEL, RACK, CurveTable

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Hub:
    """A wheel as drawn."""

    centre: Point
    """Centre of the left wheel, m."""
    ahead: float
    """Sign of the change of the wheelbase with x of the wheel: 1 front, -1 rear."""


@dataclass(frozen=True)
class WheelCurves:
    """Kinematic curves of one wheel from its table."""

    travel: Array
    """Travel of the wheel, m, shape (n,)."""
    second: Array
    """Values of the second variable, shape (k,)."""
    centres: Array
    """Wheel centres, m, shape (n, k, 3)."""
    rotations: Array
    """Rotations of the carrier from the drawing, shape (n, k, 3, 3)."""
    lengths: dict[str, Array]
    """Columns of the table for lengths of spring and damper, m, and the angle of the lever, rad, shape (n, k)."""


def wheel_axes(steer: Array, inclination: Array) -> Array:
    """Unit vectors of wheels as columns (..., 3, 3): forward and level, axis to the left, up in the wheel plane.

    `steer`, `inclination`: rad, positive to the left and with the top to the right.
    """
    zeros = np.zeros_like(steer)
    forward = np.stack([np.cos(steer), np.sin(steer), zeros], axis=-1)
    axis = np.stack(
        [-np.sin(steer) * np.cos(inclination), np.cos(steer) * np.cos(inclination), np.sin(inclination)], axis=-1
    )
    return np.stack([forward, axis, np.cross(forward, axis)], axis=-1)


def pitch_rotation(pitch: Array) -> Array:
    """Rotation of a carrier about the wheel axis in the axes of `wheel_axes`, top forward positive, (..., 3, 3)."""
    matrices = np.zeros((*pitch.shape, 3, 3))
    matrices[..., 1, 1] = 1.0
    matrices[..., 0, 0] = matrices[..., 2, 2] = np.cos(pitch)
    matrices[..., 0, 2], matrices[..., 2, 0] = np.sin(pitch), -np.sin(pitch)
    return matrices


def wheel_curves(table: CurveTable, side: Side, hub: Hub) -> WheelCurves:
    """Curves of a wheel; for the right wheel they are mirrored if the table has no columns for it.

    Angles and positions are relative to the table's at the drawing.

    `hub`: the left wheel as drawn.
    """
    has_own = table.has_right_wheel and side.name == "right"
    if has_own and table.second_name == OTHER_TRAVEL:  # the first variable is the travel of the left wheel
        table = table.exchanged()
    sign = -1.0 if has_own else 1.0
    centres, rotations = _centres_and_rotations(table, "right" if has_own else "left", sign, hub)
    lengths = {
        name: values
        for name in ("spring_length", "damper_length", "anti_roll_bar_angle")
        if (values := table.of(name, "right" if has_own else "left")) is not None
    }
    if side.name == "left" or has_own:
        return WheelCurves(table.travel, table.second, centres, rotations, lengths)
    mirror = np.array([1.0, -1.0, 1.0])
    centres, rotations = centres * mirror, mirror[:, None] * rotations * mirror
    if table.second_name != RACK:
        return WheelCurves(table.travel, table.second, centres, rotations, lengths)
    lengths = {n: v[:, ::-1] for n, v in lengths.items()}
    return WheelCurves(table.travel, -table.second[::-1], centres[:, ::-1], rotations[:, ::-1], lengths)


def _centres_and_rotations(table: CurveTable, name: str, sign: float, hub: Hub) -> tuple[Array, Array]:
    """Centres of a wheel, m, and rotations of its carrier over the table. `sign`: -1 for columns of the right wheel."""

    def column_of(column: str) -> Array | None:
        return table.of(column, name)

    def angle(outwards: str, absolute: str) -> Array:
        angles = column_of(outwards)
        if angles is not None:
            return -sign * angles
        angles = column_of(absolute)
        assert angles is not None, "checked by the reader"
        return angles

    i, k = table.drawn
    steer, inclination = angle("toe_angle", "steer_angle"), angle("camber_angle", "inclination_angle")
    pitch = column_of("carrier_pitch_angle")
    if pitch is None:  # caster changes by the pitch of the carrier, not by the steer angle
        caster = column_of("caster_angle")
        assert caster is not None, "checked by the reader"
        pitch = -np.broadcast_to(caster[:, k : k + 1], caster.shape) if table.second_name == RACK else -caster
    axes = wheel_axes(steer, inclination) @ pitch_rotation(pitch - pitch[i, k])
    rotations = axes @ axes[i, k].T
    up = wheel_axes(steer, inclination)[..., 2]
    radius = hub.centre[2] / up[i, k, 2]
    contact = -radius * (up - up[i, k])  # displacement of the contact centre relative to the wheel centre
    drawn = np.array([hub.centre[0], sign * hub.centre[1], hub.centre[2]])
    centres = np.zeros((*steer.shape, 3))
    centres[..., 2] = np.broadcast_to(table.travel[:, None], steer.shape)
    for column, c, change, scale in ((0, "x", "wheelbase_change", hub.ahead), (1, "y", "track_change", 0.5 * sign)):
        for column_name, factor, below in (
            (f"wheel_centre_{c}", 1.0, 0.0),
            (f"contact_centre_{c}", 1.0, 1.0),
            (change, scale, 1.0),
        ):
            values = column_of(column_name)
            if values is not None:
                centres[..., column] = factor * (values - values[i, k]) - below * contact[..., column]
                break
    return drawn + centres, rotations
