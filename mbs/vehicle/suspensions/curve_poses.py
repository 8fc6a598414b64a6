"""Places and rotations of a wheel carrier from the columns of its table."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mbs.vehicle.side import Point, Side
from mbs.vehicle.suspensions.curve_table import OTHER, RACK, CurveTable

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Hub:
    """A wheel as drawn."""

    centre: Point
    """Of the left wheel, m."""
    ahead: float
    """1 of a front wheel, -1 of a rear one, which lengthens the wheelbase as it goes back."""


@dataclass(frozen=True)
class WheelCurves:
    """Kinematic curves of one wheel from its table."""

    travel: Array
    """Shape (n,): of this wheel, m."""
    second: Array
    """Shape (k,): points of the second variable for this wheel."""
    centres: Array
    """Shape (n, k, 3): of the wheel, m."""
    rotations: Array
    """Shape (n, k, 3, 3): of the carrier from the drawing."""
    lengths: dict[str, Array]
    """Each of shape (n, k): lengths of spring and damper, m, and the angle of the lever, rad, where the table has
    them."""


def axes_of(steer: Array, inclination: Array) -> Array:
    """Unit vectors of wheels: forward and level, their axis to the left, up in their plane, as columns (..., 3, 3).

    `steer`, `inclination`: in rad, positive to the left and with the top to the right.
    """
    nought = np.zeros_like(steer)
    forward = np.stack([np.cos(steer), np.sin(steer), nought], axis=-1)
    axis = np.stack(
        [-np.sin(steer) * np.cos(inclination), np.cos(steer) * np.cos(inclination), np.sin(inclination)], axis=-1
    )
    return np.stack([forward, axis, np.cross(forward, axis)], axis=-1)


def pitched(pitch: Array) -> Array:
    """Turn of a carrier about its wheel's axis in those axes, positive with the top forward, shape (..., 3, 3)."""
    matrices = np.zeros((*pitch.shape, 3, 3))
    matrices[..., 1, 1] = 1.0
    matrices[..., 0, 0] = matrices[..., 2, 2] = np.cos(pitch)
    matrices[..., 0, 2], matrices[..., 2, 0] = np.sin(pitch), -np.sin(pitch)
    return matrices


def wheel_curves(table: CurveTable, side: Side, hub: Hub) -> WheelCurves:
    """The motion of a wheel; that of the right one mirrors the left where the table has no columns of its own for it.

    Angles count from those of the table at the drawing, as positions do: there the wheel is as drawn.

    `hub`: the left wheel as drawn.
    """
    has_own = table.both and side.name == "right"
    if has_own and table.second_name == OTHER:  # whose rows are places of the axle: the left wheel's travel comes first
        table = table.exchanged()
    sign = -1.0 if has_own else 1.0
    centres, rotations = _motion(table, "right" if has_own else "left", sign, hub)
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


def _motion(table: CurveTable, name: str, sign: float, hub: Hub) -> tuple[Array, Array]:
    """Centres of a wheel and rotations of its carrier over the table."""

    def of(column: str) -> Array | None:
        return table.of(column, name)

    def angle(outwards: str, absolute: str) -> Array:
        angles = of(outwards)
        if angles is not None:
            return -sign * angles
        angles = of(absolute)
        assert angles is not None, "checked by the reader"
        return angles

    i = int(np.argmin(np.abs(table.travel)))
    k = int(np.argmin(np.abs(table.second)))
    steer, inclination = angle("toe_angle", "steer_angle"), angle("camber_angle", "inclination_angle")
    pitch = of("carrier_pitch_angle")
    if pitch is None:  # the steering axis is fixed to the carrier: caster changes as the carrier pitches, not by steer
        caster = of("caster_angle")
        assert caster is not None, "checked by the reader"
        pitch = -np.broadcast_to(caster[:, k : k + 1], caster.shape) if table.second_name == RACK else -caster
    axes = axes_of(steer, inclination) @ pitched(pitch - pitch[i, k])
    rotations = axes @ axes[i, k].T
    up = axes_of(steer, inclination)[..., 2]
    radius = hub.centre[2] / up[i, k, 2]
    contact = -radius * (up - up[i, k])  # of the contact centre less that of the wheel's
    drawn = np.array([hub.centre[0], sign * hub.centre[1], hub.centre[2]])
    centres = np.zeros((*steer.shape, 3))
    centres[..., 2] = np.broadcast_to(table.travel[:, None], steer.shape)
    for column, c, change, scale in ((0, "x", "wheelbase_change", hub.ahead), (1, "y", "track_change", 0.5 * sign)):
        for column_name, factor, below in (
            (f"wheel_centre_{c}", 1.0, 0.0),
            (f"contact_centre_{c}", 1.0, 1.0),
            (change, scale, 1.0),
        ):
            values = of(column_name)
            if values is not None:
                centres[..., column] = factor * (values - values[i, k]) - below * contact[..., column]
                break
    return drawn + centres, rotations
