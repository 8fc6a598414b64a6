"""Kinematics of a car: curves of both axles, values at the drawing, and notes."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from mbs.common.checks import instance_of, is_finite, shown
from mbs.common.errors import ModelError
from mbs.vehicle.car import Car
from mbs.vehicle.kinematics.curves import Curve, steer_curve, travel_curve
from mbs.vehicle.kinematics.steer_measures import WheelByRack
from mbs.vehicle.linkages.linkage import Linkage

Array = NDArray[np.float64]

TRAVEL = (-0.08, 0.08)
"""Default range of wheel travel, m."""
POINTS = 81
"""Default number of points of a curve."""
MOTIONS = ("parallel", "opposite", "single")
ANGLE_TOLERANCE = 1e-9
"""Largest difference of the angles of both wheels with the same setting, rad."""
MAX_TRAVEL = 0.5  # m
MAX_POINTS = 10_001


@dataclass(frozen=True)
class Kinematics:
    """Wheel travel and steer curves of a car."""

    car: str
    curves: dict[tuple[str, str], Curve]
    """By axle, of those with links, and motion; "steer" of the front axle alone."""
    notes: tuple[str, ...]
    """Sentences on curves that end early, ranges that go into the stops, and axles without links."""

    def drawn(self, axle: str) -> dict[str, float]:
        """Values and gradients at the drawing, SI units.

        Returns
        -------
        dict of str to float
            Of the left wheel and the axle, by the quantities' names; toe and camber of a right wheel that is set
            otherwise, as ``right_toe_angle``; columns of roll are from opposite travel, columns of steering from the
            steer curve: ratio at straight ahead, angles, Ackermann and turning circle at full lock. Empty: it has no
            links.
        """
        if (axle, "parallel") not in self.curves:
            return {}
        parallel = self.curves[axle, "parallel"].drawn()
        drawn_values = {n.removesuffix("_left"): v for n, v in parallel.items() if not n.endswith("_right")}
        for name in ("toe_angle", "camber_angle"):
            if abs(parallel[f"{name}_right"] - drawn_values[name]) > ANGLE_TOLERANCE:
                drawn_values[f"right_{name}"] = parallel[f"{name}_right"]
        opposite = self.curves[axle, "opposite"].drawn()
        drawn_values |= {n: v for n, v in opposite.items() if n in ("roll_steer", "roll_camber", "roll_stiffness")}
        drawn_values["roll_wheel_rate"] = opposite["wheel_rate_left"]
        steer = self.curves.get((axle, "steer"))
        if steer is not None:
            drawn_values["steering_ratio"] = steer.drawn()["steering_ratio"]
            lock = {name: float(values[-1]) for name, values in steer.columns.items()}
            drawn_values["lock_steering_wheel_angle"] = lock["steering_wheel_angle"]
            drawn_values["lock_inner"], drawn_values["lock_outer"] = lock["steer_angle_left"], lock["steer_angle_right"]
            drawn_values |= {f"lock_{name}": lock[name] for name in ("ackermann", "ackermann_error", "turning_circle")}
        return drawn_values


def kinematics(
    car: Car,
    travel: tuple[float, float] = TRAVEL,
    points: int = POINTS,
    progress: Callable[[float], None] | None = None,
) -> Kinematics:
    """Wheel travel and steer curves of the axles with links, the chassis held and rigid, in SI units.

    Parameters
    ----------
    travel : (float, float)
        Least and largest wheel travel, m, from the drawing, positive in bump; 0 is between them.
    points : int
        Of each curve; one at the drawing is added if there is none.
    progress : callable, optional
        Receives the fraction done.

    Raises
    ------
    ModelError
        The travel does not span 0, there are too few or too many points, or no axle has links.
    """
    instance_of(Car, car, "The car of kinematics()", "a Car of mbs.vehicle.load()")
    low, high = checked_travel(travel)
    if not isinstance(points, int) or isinstance(points, bool) or not 3 <= points <= MAX_POINTS:
        raise ModelError(f"points = {shown(points)}; it must be a whole number between 3 and {MAX_POINTS}.")
    common_range = min(-low, high)
    curves: dict[tuple[str, str], Curve] = {}
    notes: list[str] = []
    if not car.linked_axles:
        car.front.suspension.require_links()
    for axle in car.linked_axles:
        linkage = Linkage(car, axle)
        for motion in MOTIONS:
            ends = (-common_range, common_range) if motion == "opposite" else (low, high)
            curves[axle, motion] = travel_curve(linkage, motion, _grid(*ends, points))
            _report(progress, len(curves))
        if axle == "front":
            full = car.steering.full
            curves[axle, "steer"] = steer_curve(linkage, _grid(-full, full, points), wheel_by_rack(car))
            _report(progress, len(curves))
        notes += stop_notes(linkage, curves[axle, "parallel"])
    ends_early = [note for curve in curves.values() for note in curve.notes]
    unlinked = [axle.suspension.unlinked for axle in car.axles.values()]
    return Kinematics(car.name, curves, (*ends_early, *notes, *filter(None, unlinked)))


def wheel_by_rack(car: Car) -> WheelByRack:
    """Function of the motion of the steering, m or rad: angle of the steering wheel, rad, and its derivative."""
    sign = car.steering.signed(car.rack_direction)

    def angle_and_rate(travel: float) -> tuple[float, float]:
        angle, rate = car.steering.wheel_at(travel)
        return sign * angle, sign * rate

    return angle_and_rate


def checked_travel(travel: object) -> tuple[float, float]:
    """Check a range of wheel travel, m. Raises `ModelError` if it is not two numbers around 0."""
    if not isinstance(travel, (tuple, list)) or len(travel) != 2 or not all(is_finite(v) for v in travel):
        raise ModelError(f"The range of wheel travel is {shown(travel)}; it must be two numbers, m.")
    low, high = (float(v) for v in travel)
    if not (-MAX_TRAVEL <= low < 0.0 < high <= MAX_TRAVEL):
        raise ModelError(
            f"The wheel travel goes from {low:g} to {high:g} m; it must go from below 0, -{MAX_TRAVEL:g} m or "
            f"more, to above 0, {MAX_TRAVEL:g} m or less (positive in bump; 0 is the drawing)."
        )
    return low, high


def _grid(low: float, high: float, points: int) -> Array:
    """Equidistant values, with 0 added if it is not among them."""
    grid = np.linspace(low, high, points)
    nearest = int(np.argmin(np.abs(grid)))
    if abs(grid[nearest]) < 1e-9 * (high - low):
        grid[nearest] = 0.0
        return grid
    return np.sort(np.append(grid, 0.0))


def _report(progress: Callable[[float], None] | None, done: int) -> None:
    """Report the fraction of completed curves. `done`: their number."""
    if progress is not None:
        progress(done / (2 * len(MOTIONS) + 1))


def stop_notes(linkage: Linkage, parallel: Curve) -> list[str]:
    """Sentences on the travel at which the stops become metal on metal, if a curve exceeds it.

    `parallel`: curve of parallel wheel travel.
    """
    stops = linkage.data.stops
    if stops is None:
        return []
    notes = []
    for name, end, compression in (
        ("bump", 1.0, stops.bump_gap + stops.bump_travel),
        ("rebound", -1.0, stops.rebound_gap + stops.rebound_travel),
    ):
        travel = travel_of_compression(parallel, end * compression)
        last = float(parallel["wheel_travel_left"][-1 if end > 0.0 else 0])
        if not np.isnan(travel):
            notes.append(
                f"{linkage.name} axle: the range goes to {1e3 * last:+.1f} mm of wheel travel, but from "
                f"{1e3 * travel:+.1f} mm on the {name} stops are metal on metal; what lies beyond is geometry only."
            )
    return notes


def travel_of_compression(parallel: Curve, compression: float) -> float:
    """Wheel travel at a compression of the spring from the drawing, m; NaN: it is not on the curve.

    `parallel`: curve of parallel wheel travel; `compression`: m, negative in extension.
    """
    compressed = parallel.drawn()["spring_length_left"] - parallel["spring_length_left"]
    rising, first = np.unique(compressed, return_index=True)
    travel = PchipInterpolator(rising, parallel["wheel_travel_left"][first], extrapolate=False)
    return float(travel(compression))
