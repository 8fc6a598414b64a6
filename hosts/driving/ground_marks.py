"""Ground marks of a manoeuvre in the plane: lanes, circles, the line where braking begins."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, TypeAlias

import numpy as np

from hosts.driving.result import Result

Mark: TypeAlias = dict[str, Any]
"""Kind and coordinates x and y, m, of lanes, a line or a circle."""
_LINE_LENGTH = 4.0  # m, of a line across the path
_SHORTEST_CIRCLE = 10.0  # s of constant steering
_SETTLING = 2.0  # s, until the car drives the circle
_LEAST_SPEED = 1.0  # m/s


def with_ground_marks(result: Result, pilot: object | None) -> Result:
    """A run with the marks of its pilot, or without a pilot those of its inputs."""
    return replace(result, marks=marks_of_inputs(result) if pilot is None else marks_of(pilot))


def marks_of(pilot: object) -> list[Mark]:
    """The marks of a pilot, if it has any."""
    return list(getattr(pilot, "marks", ()))


def lanes(gates: Sequence[Sequence[float]], pose: tuple[float, float, float]) -> Mark:
    """Lanes between cones, each by begin, end, right and left edge, in axes at the pose x, y, yaw; m and rad."""
    return {"kind": "lanes", "gates": [list(gate) for gate in gates], "pose": list(pose)}


def circle(centre: tuple[float, float], radius: float) -> Mark:
    """A circle. `centre`, `radius`: m."""
    return {"kind": "circle", "centre": list(centre), "radius": radius}


def line_across(x: float, y: float, yaw: float) -> Mark:
    """A line across the path of a car at x, y with the heading yaw, m and rad."""
    dx, dy = -0.5 * _LINE_LENGTH * math.sin(yaw), 0.5 * _LINE_LENGTH * math.cos(yaw)
    return {"kind": "line", "points": [[x + dx, y + dy], [x - dx, y - dy]], "colour": "yellow"}


def marks_of_inputs(result: Result) -> list[Mark]:
    """Marks of inputs over time: the circle of a constant steering, or the line where a straight run begins to brake.

    The circle is that of speed and yaw rate 2 s after the last change of the steering, which must then be constant for
    10 s or more; a car that becomes faster leaves it.
    """
    if not {"steering", "brake", "chassis.x", "chassis.y", "chassis.yaw", "speed"} <= set(result.names):
        return []
    steering, brake, time = result["steering"], result["brake"], result.time
    if not steering.any():
        unbraked = np.flatnonzero(brake <= 0.0)
        begin = int(unbraked[-1]) if len(unbraked) else len(time) - 1
        if begin == len(time) - 1 or not abs(result["speed"][begin]) > _LEAST_SPEED:
            return []
        return [line_across(*(float(result[name][begin]) for name in ("chassis.x", "chassis.y", "chassis.yaw")))]
    constant_from = int(np.flatnonzero(steering != steering[-1])[-1]) + 1 if (steering != steering[-1]).any() else 0
    settled = int(np.searchsorted(time, time[constant_from] + _SETTLING))
    if steering[-1] == 0.0 or time[-1] - time[constant_from] < _SHORTEST_CIRCLE or "chassis.wz" not in result:
        return []
    names = ("chassis.x", "chassis.y", "chassis.yaw", "speed", "chassis.wz")
    x, y, yaw, speed, rate = (float(result[name][settled]) for name in names)
    yaw += float(result["sideslip"][settled]) if "sideslip" in result else 0.0
    if not (abs(speed) > _LEAST_SPEED and abs(rate) * 1000.0 > abs(speed)):
        return []
    radius = speed / rate
    return [circle((x - radius * math.sin(yaw), y + radius * math.cos(yaw)), abs(radius))]
