"""A driver that follows a course: pure pursuit of a point ahead on the path, speed held with throttle and brake."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields

import numpy as np

from hosts.course import Course, course_of
from hosts.errors import HostError

SENSES = ("chassis.x", "chassis.y", "chassis.yaw", "speed")
ACTS = ("steering", "throttle", "brake")


@dataclass(frozen=True)
class DriverSettings:
    """What a driver knows of the car and wants.

    Parameters
    ----------
    speed : float
        To be held, m/s.
    preview_time : float
        How far ahead the driver looks, s.
    wheelbase : float
        m.
    rear_axle : float
        Distance from the origin of the vehicle axes back to the rear axle, m.
    wheel_angle_max : float
        Mean angle of the front wheels at full steering, rad.
    vehicle_length, vehicle_width : float
        Outline centred on the wheelbase, m.
    speed_gain, speed_integral : float
        Pedal per m/s, pedal per m.
    """

    speed: float
    preview_time: float = 0.5
    wheelbase: float = 2.3
    rear_axle: float = 1.0
    wheel_angle_max: float = 0.525
    vehicle_length: float = 3.2
    vehicle_width: float = 1.5
    speed_gain: float = 0.3
    speed_integral: float = 0.1


class Driver:
    """Closed loop from the car's position to its pedals and steering.

    Parameters
    ----------
    course : Course
    settings : DriverSettings
    """

    def __init__(self, course: Course, settings: DriverSettings) -> None:
        self.course = course
        self.settings = settings
        self._integral = 0.0
        self._time = 0.0

    def act(self, time: float, senses: Mapping[str, float]) -> dict[str, float]:
        """Inputs for the coming communication step.

        Parameters
        ----------
        time : float
            s.
        senses : mapping of str to float
            `SENSES`, SI units, earth axes.

        Returns
        -------
        dict of str to float
            `ACTS`.
        """
        s = self.settings
        yaw, speed = senses["chassis.yaw"], max(senses["speed"], 1.0)
        x = senses["chassis.x"] - s.rear_axle * math.cos(yaw)
        y = senses["chassis.y"] - s.rear_axle * math.sin(yaw)
        # The arc from the rear axle, tangent to the heading, through the point ahead (pure pursuit).
        ahead = s.wheelbase + s.preview_time * speed
        dx = x + ahead
        dy = float(self.course.path(np.array(dx))) - y
        lateral = -math.sin(yaw) * ahead + math.cos(yaw) * dy
        curvature = 2.0 * lateral / (ahead * ahead + dy * dy)
        steering = math.atan(s.wheelbase * curvature) / s.wheel_angle_max
        error = s.speed - senses["speed"]
        step, self._time = time - self._time, time
        pedal = s.speed_gain * error + s.speed_integral * self._integral
        if -1.0 < pedal < 1.0:
            self._integral += step * error
        return {
            "steering": min(max(steering, -1.0), 1.0),
            "throttle": min(max(pedal, 0.0), 1.0),
            "brake": min(max(-pedal, 0.0), 1.0),
        }


def make_driver(settings: Mapping[str, str]) -> Driver:
    """Driver from the ``[driver]`` section of a manoeuvre.

    Parameters
    ----------
    settings : mapping of str to str
        ``course`` and the fields of `DriverSettings`.

    Returns
    -------
    Driver
    """
    numbers = {}
    known = {f.name for f in fields(DriverSettings)}
    for name, text in settings.items():
        if name == "course":
            continue
        if name not in known:
            raise HostError(f"[driver] has '{name}'; known are course, {', '.join(sorted(known))}.")
        try:
            numbers[name] = float(text)
        except ValueError:
            raise HostError(f"[driver] {name} = {text} is not a number.") from None
    if "speed" not in numbers or "course" not in settings:
        raise HostError("[driver] needs a course and a speed.")
    values = DriverSettings(**numbers)
    return Driver(course_of(settings["course"], values.vehicle_width), values)
