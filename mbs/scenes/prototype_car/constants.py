"""Constants of the FMU that a driver or a course needs."""

from __future__ import annotations

import math

from mbs.model import Model
from mbs.scenes.prototype_car import car_data


def vehicle_constants(m: Model) -> None:
    """Dimensions of the car and its steering."""
    front, rear = (axle["wheel_centre"] for axle in (car_data.FRONT, car_data.REAR))
    turned = 2.0 * math.pi * car_data.RACK_TRAVEL / car_data.RACK_PER_TURN
    angle = car_data.FRONT_WHEEL_ANGLE_MAX
    for name, value, unit, text in (
        ("wheelbase", car_data.WHEELBASE, "m", "distance between the axles"),
        ("track_front", 2.0 * front[1], "m", "distance between the centres of the front wheels"),
        ("track_rear", 2.0 * rear[1], "m", "distance between the centres of the rear wheels"),
        ("length", car_data.LENGTH, "m", "length of the outline, centred on the origin of the vehicle's axes"),
        ("width", car_data.WIDTH, "m", "width of the outline without mirrors, centred on that origin too"),
        ("steering_wheel_angle_max", turned, "rad", "angle of the steering wheel at steering = 1"),
        ("front_wheel_angle_max", angle, "rad", "mean steering angle of the front wheels at steering = 1"),
        ("steering_ratio", turned / angle, "1", "angle of the steering wheel over that of the front wheels, both full"),
    ):
        m.constant(f"vehicle.{name}", value, unit, text)
