"""Ackermann's condition, turning circle and steering ratio of a steered axle at one position.

Without slip the axes of both front wheels intersect on the line of the rear axle. Position and steer angle of each
wheel give a centre of the turn on that line; the Ackermann steer angle of the outer wheel is that for the centre of the
inner one.
"""

import math
from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from mbs.vehicle.kinematics.wheel_motion import wheel_motion
from mbs.vehicle.linkages.linkage import Linkage, Position

WheelByRack: TypeAlias = Callable[[float], tuple[float, float]]
MIN_STEER_ANGLE = 1e-4  # rad, with a turning circle


def steer_measures(linkage: Linkage, position: Position, wheel_by_rack: WheelByRack) -> dict[str, float]:
    """Columns of steering in SI units; NaN if the wheels are straight ahead or turned to different sides.

    `wheel_by_rack`: gives the angle of the steering wheel, rad, and its change per travel of the rack, rad/m, at a
    travel, m.
    """
    wheels = [wheel_motion(linkage, position, k) for k in range(2)]
    steers = [w.steer for w in wheels]
    mean = 0.5 * sum(steers)
    rate = 0.5 * float((wheels[0].steer_rate + wheels[1].steer_rate)[2])
    angle, wheel_per_rack = wheel_by_rack(position.rack)
    measures = {
        "steering_wheel_angle": angle,
        linkage.car.steering.motion: position.rack,
        "mean_steer_angle": mean,
        "steering_ratio": wheel_per_rack / rate if rate else math.nan,
        **dict.fromkeys(("ackermann_steer_angle", "ackermann_error", "ackermann", "turning_circle"), math.nan),
    }
    if min(abs(s) for s in steers) < MIN_STEER_ANGLE or steers[0] * steers[1] < 0.0:
        return measures
    inner, outer = wheels if mean > 0.0 else wheels[::-1]
    axle_x = linkage.car.rear.wheel.centre[0]

    def centre(contact: np.ndarray, steer: float) -> float:
        """y of the centre of the turn, m."""
        return float(contact[1] + (contact[0] - axle_x) / math.tan(steer))

    inner_centre = centre(inner.contact, inner.steer)
    ackermann_angle = math.atan((outer.contact[0] - axle_x) / (inner_centre - outer.contact[1]))
    middle = 0.5 * (inner_centre + centre(outer.contact, outer.steer))
    measures["ackermann_steer_angle"] = ackermann_angle
    measures["ackermann_error"] = abs(outer.steer) - abs(ackermann_angle)
    measures["ackermann"] = 100.0 * (inner.steer - outer.steer) / (inner.steer - ackermann_angle)
    measures["turning_circle"] = 2.0 * math.hypot(outer.contact[0] - axle_x, outer.contact[1] - middle)
    return measures
