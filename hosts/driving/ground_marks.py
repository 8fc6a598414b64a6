"""Ground marks of a manoeuvre in the plane: lanes, circles, the line where braking begins."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, TypeAlias

import numpy as np

from hosts.driving.result import Result

Mark: TypeAlias = dict[str, Any]
"""Kind and places, x and y, m: lanes, a line or a circle."""
_ACROSS = 4.0  # m, of a line across the way
_STEADY = 10.0  # s that a steering angle must be held to make a circle
_SETTLED = 2.0  # s until the circle is driven
_MOVES = 1.0  # m/s


def marked(result: Result, pilot: object | None) -> Result:
    """A run with the marks that its pilot drives by, or without a pilot those that its inputs show."""
    return replace(result, marks=marks_of_inputs(result) if pilot is None else marks_of(pilot))


def marks_of(pilot: object) -> list[Mark]:
    """What a pilot drives by; nothing of one that drives by nothing that can be seen."""
    return list(getattr(pilot, "marks", ()))


def lanes(gates: Sequence[Sequence[float]], pose: tuple[float, float, float]) -> Mark:
    """Lanes between cones, each by begin, end, right and left edge, in axes that lie at x, y, yaw; m and rad."""
    return {"kind": "lanes", "gates": [list(gate) for gate in gates], "pose": list(pose)}


def circle(centre: tuple[float, float], radius: float) -> Mark:
    """A circle, m."""
    return {"kind": "circle", "centre": list(centre), "radius": radius}


def line_across(x: float, y: float, yaw: float) -> Mark:
    """A line across the way of a car that is at x, y and goes along yaw, m and rad."""
    dx, dy = -0.5 * _ACROSS * math.sin(yaw), 0.5 * _ACROSS * math.cos(yaw)
    return {"kind": "line", "points": [[x + dx, y + dy], [x - dx, y - dy]], "colour": "yellow"}


def marks_of_inputs(result: Result) -> list[Mark]:
    """Of inputs over time: the circle that a steering which stays begins with, or where a straight run begins to stop.

    The circle is that of speed and yaw rate 2 s after the steering stays, where it then stays for 10 s or more; a car
    that is faster later leaves it.
    """
    if not {"steering", "brake", "chassis.x", "chassis.y", "chassis.yaw", "speed"} <= set(result.names):
        return []
    steering, brake, time = result["steering"], result["brake"], result.time
    if not steering.any():
        free = np.flatnonzero(brake <= 0.0)
        begins = int(free[-1]) if len(free) else len(time) - 1
        if begins == len(time) - 1 or not abs(result["speed"][begins]) > _MOVES:
            return []
        return [line_across(*(float(result[name][begins]) for name in ("chassis.x", "chassis.y", "chassis.yaw")))]
    stays = int(np.flatnonzero(steering != steering[-1])[-1]) + 1 if (steering != steering[-1]).any() else 0
    settled = int(np.searchsorted(time, time[stays] + _SETTLED))
    if steering[-1] == 0.0 or time[-1] - time[stays] < _STEADY or "chassis.wz" not in result:
        return []
    names = ("chassis.x", "chassis.y", "chassis.yaw", "speed", "chassis.wz")
    x, y, yaw, speed, rate = (float(result[name][settled]) for name in names)
    yaw += float(result["sideslip"][settled]) if "sideslip" in result else 0.0
    if not (abs(speed) > _MOVES and abs(rate) * 1000.0 > abs(speed)):
        return []
    radius = speed / rate
    return [circle((x - radius * math.sin(yaw), y + radius * math.cos(yaw)), abs(radius))]
