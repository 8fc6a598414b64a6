"""Curves of an axle against wheel travel and steering."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mbs.vehicle.kinematics.axle_measures import roll_measures, travel_measures, wheel_measures
from mbs.vehicle.kinematics.quantities import BY_NAME, quantity_of
from mbs.vehicle.kinematics.steer_measures import WheelByRack, steer_measures
from mbs.vehicle.kinematics.wheel_loads import SINGLE
from mbs.vehicle.linkages.continuation import HEAVE, ROLL, ROUND_OFF, STEER, positions_along
from mbs.vehicle.linkages.linkage import SIDES, Linkage, Position

Array = NDArray[np.float64]

DIRECTIONS = {"parallel": HEAVE, "opposite": ROLL, "single": SINGLE[0], "steer": STEER}
"""Rates of the travels of the left and the right wheel and of the rack, by name of the motion."""
WORDS = {
    "parallel": "parallel wheel travel",
    "opposite": "opposite wheel travel (roll)",
    "single": "travel of the left wheel alone",
    "steer": "steering",
}
"""Names of the motions in sentences."""


@dataclass(frozen=True)
class Curve:
    """Columns along a motion."""

    axle: str
    motion: str
    """Both wheels "parallel", left up as right goes down "opposite", the left one alone "single", the rack "steer"."""
    columns: dict[str, Array]
    """By name, each of shape (n,), in SI units; names of a wheel have ``_left`` or ``_right`` behind the name of their
    quantity."""
    notes: tuple[str, ...] = ()
    """Sentences, if the curve ends before its range does."""

    def __getitem__(self, name: str) -> Array:
        return self.columns[name]

    @property
    def units(self) -> dict[str, str]:
        """Unit of each column."""
        return {name: quantity_of(name).unit for name in self.columns}

    @property
    def over(self) -> str:
        """Name of the column that the motion sets."""
        return "steering_wheel_angle" if self.motion == "steer" else "wheel_travel_left"

    def drawn(self) -> dict[str, float]:
        """Values at the drawing, where the motion is zero, by column."""
        k = int(np.argmin(np.abs(self.columns[self.over])))
        return {name: float(values[k]) for name, values in self.columns.items()}


def travel_curve(linkage: Linkage, motion: str, travel: Array) -> Curve:
    """A curve against the travel of the left wheel.

    Parameters
    ----------
    motion : {"parallel", "opposite", "single"}
        Motion of the right wheel.
    travel : ndarray, shape (n,)
        Rising, with 0 among them, m.
    """
    direction = DIRECTIONS[motion]

    def measures(position: Position) -> dict[str, float]:
        values = wheel_measures(linkage, position) | travel_measures(linkage, position, direction)
        return values | (roll_measures(linkage, position) if motion == "opposite" else {})

    return _curve(linkage, motion, travel, measures)


def steer_curve(linkage: Linkage, rack: Array, wheel_by_rack: WheelByRack) -> Curve:
    """A curve against the travel of the rack, the wheel centres at the height of the drawing.

    `rack`: rising, with 0 among them, m, shape (n,); `wheel_by_rack`: gives the angle of the steering wheel, rad, and
    its change per travel of the rack, rad/m, at a travel, m.
    """

    def measures(position: Position) -> dict[str, float]:
        return wheel_measures(linkage, position) | steer_measures(linkage, position, wheel_by_rack)

    curve = _curve(linkage, "steer", rack, measures)
    if wheel_by_rack(0.0)[1] > 0.0:
        return curve
    return Curve(curve.axle, curve.motion, {n: v[::-1] for n, v in curve.columns.items()}, curve.notes)


def _curve(linkage: Linkage, motion: str, values: Array, measures: Callable[[Position], dict[str, float]]) -> Curve:
    """Curve of the measures along a motion at values of its variable, m or rad; it ends where the linkage ends."""
    direction, notes = DIRECTIONS[motion], []
    values = np.where(np.abs(values) < ROUND_OFF, 0.0, values)
    below, low = positions_along(linkage, direction, values[values < 0.0][::-1])
    above, high = positions_along(linkage, direction, values[values > 0.0])
    for end, last in ((low, values[0]), (high, values[-1])):
        if end is not None:
            quantity = quantity_of(linkage.car.steering.motion if motion == "steer" else "wheel_travel")
            notes.append(
                f"{linkage.name} axle, {WORDS[motion]}: the links allow no more than {quantity.factor * end:+.1f} "
                f"{quantity.shown} of {quantity.title} (a dead point, or a link too short or too long); the curve ends "
                f"there, not at {quantity.factor * last:+.1f} {quantity.shown}."
            )
    middle = [linkage.drawn] if np.any(values == 0.0) else []
    rows = [measures(position) for position in (*below[::-1], *middle, *above)]
    columns = {name: np.array([row[name] for row in rows]) + 0.0 for name in rows[0]}  # no -0.0
    (x, y), (other_x, other_y) = ([columns[f"contact_centre_{c}_{side}"] for c in "xy"] for side in SIDES)
    columns["track_change"] = y - other_y - linkage.data.track
    shift = 0.5 * (x + other_x) - linkage.data.wheel.centre[0]
    columns["wheelbase_change"] = shift if linkage.name == "front" else -shift
    order = [n for name in BY_NAME for n in (name, f"{name}_left", f"{name}_right") if n in columns]
    return Curve(linkage.name, motion, {name: columns[name] for name in order}, tuple(notes))
