"""The verdict on the course that the driver of a run followed."""

import math

import numpy as np
from numpy.typing import NDArray

from hosts.driving.manoeuvre import INITIAL_SPEED
from hosts.driving.pilots.course_follower import CourseFollower
from hosts.driving.result import Result

_SPEED_TOLERANCE = 3.0  # km/h, of the entry in ISO 3888
_STANDING_SPEED = 0.5  # m/s: a slower car stands, and a later stop time would not help


def course_result(result: Result, driver: CourseFollower) -> tuple[list[tuple[str, str]], NDArray[np.float64]]:
    """The verdict as a row of the summary table, none without a recorded path, and the gates.

    "passed": the vehicle stayed inside all gates and entered them at the target speed. The gates have the shape
    (gates, 4): first and last x, right and left y, m.
    """
    course = driver.course
    gates = np.array([(g.x_start, g.x_end, g.y_right, g.y_left) for g in course.gates])
    if any(f"chassis.{name}" not in result for name in ("x", "y", "yaw")):
        return [], gates
    return [(course.name, _verdict(result, driver))], gates


def _verdict(result: Result, driver: CourseFollower) -> str:
    course, length, width = driver.course, driver.settings.vehicle_length, driver.settings.vehicle_width
    x, y, yaw = (result[f"chassis.{name}"] for name in ("x", "y", "yaw"))
    excess = course.corners_outside(x, y, yaw, length, width)
    target, speed = 3.6 * driver.settings.speed, 3.6 * result["speed"]
    inside = x + 0.5 * length >= course.gates[0].x_start
    entry = float(speed[int(inside.argmax())]) if inside.any() else math.nan
    entered = f"entered at {entry:.1f} km/h, {target:.1f} km/h asked for"
    missing = course.not_driven(x, length)
    if missing and excess > 0.0:
        return f"missed by {excess:.2f} m; {missing}"
    if missing:
        return f"not passed: {missing}{_remedy(result, driver)}"
    if excess > 0.0:
        return f"missed by {excess:.2f} m; {entered}"
    if not abs(entry - target) <= _SPEED_TOLERANCE:
        remedy = f"--driver speed={entry / 3.6:.3g} asks for that"
        if INITIAL_SPEED in result.start and result.start[INITIAL_SPEED] != driver.settings.speed:
            remedy = f"start with --set {INITIAL_SPEED}={driver.settings.speed:g}"
        return f"not passed: {entered}; {remedy}"
    return f"passed, {-excess:.2f} m to spare; {entered}"


def _remedy(result: Result, driver: CourseFollower) -> str:
    """A remedy where not all lanes were driven, as the end of a sentence."""
    x, speed, gates = result["chassis.x"], float(result["speed"][-1]), driver.course.gates
    if (late := x[0] + 0.5 * driver.settings.vehicle_length - gates[0].x_start) > 0.0:
        return f"; start {late:.4g} m or more before"
    if result.failed_steps:
        return "; the FMU refused the next step"
    if (distance := gates[-1].x_end + 0.5 * driver.settings.vehicle_length - float(x[-1])) <= 0.0:
        return "; run without --interval"
    if speed < _STANDING_SPEED:
        return f"; the car stands at {result.time[-1]:.4g} s"
    if len(x) > 1 and x[-1] < x[-2]:
        return "; at its end the car drives back"
    return f"; --stop-time {math.ceil(result.time[-1] + 1.1 * distance / speed)} is long enough at its speed"
