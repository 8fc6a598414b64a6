"""A synthetic turn whose measures are known in closed form."""

import math

import numpy as np

from hosts.catalogue.circle_stop import Stop
from hosts.driving.result import Result


def turn(deceleration: float, factor: float, radius: float, drift: float) -> Stop:
    """A stop from a circle on which the yaw rate becomes `factor` times that which keeps it, at once.

    The path stays the circle, but `drift` m/s outwards; the sideslip changes by 0.05 rad towards the outside.
    """
    onset, step, v0 = 2.0, 0.002, 20.0
    time = step * np.arange(3001)
    since = np.maximum(time - onset, 0.0)
    speed = np.maximum(v0 - deceleration * since, 0.1)
    distance = v0 * np.minimum(time, onset) + np.where(since > 0, v0 * since - 0.5 * deceleration * since**2, 0.0)
    side, size = math.copysign(1.0, radius), abs(radius)
    angle, r = distance / size, size + drift * since
    x, y = r * np.sin(angle), side * (size - r * np.cos(angle))
    rate = speed / radius * np.where(since > 0, factor, 1.0)
    sideslip = -side * (0.02 + np.where(since > 0, 0.05, 0.0))
    names = ["speed", "chassis.x", "chassis.y", "chassis.wz", "sideslip", "chassis.ay"]
    columns = np.column_stack([speed, x, y, rate, sideslip, speed**2 / radius])
    return Stop(0.5, Result(names, dict.fromkeys(names, "1"), time, columns, 0.0, 6.0, 0, []), onset, "stands")
