"""A driver that follows a course with a view ahead, and holds the speed with throttle and brake."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields

from hosts.course import Course, course_of
from hosts.errors import HostError
from hosts.numbers import parse_number

SENSES = ("chassis.x", "chassis.y", "chassis.yaw", "speed")
_POSITIVE = ("speed", "wheelbase", "wheel_angle_max", "vehicle_length", "vehicle_width")
ACTS = ("steering", "throttle", "brake")


CONSTANTS = {
    "wheelbase": "vehicle.wheelbase",
    "wheel_angle_max": "vehicle.front_wheel_angle_max",
    "vehicle_length": "vehicle.length",
    "vehicle_width": "vehicle.width",
}
"""Numbers of the car that a driver needs: setting and the constant of the FMU that has it."""


@dataclass(frozen=True)
class DriverSettings:
    """What a driver knows of the car and wants.

    Parameters
    ----------
    speed : float
        To be held, m/s.
    wheelbase : float
        m.
    wheel_angle_max : float
        Mean angle of the front wheels at full steering, rad.
    vehicle_length, vehicle_width : float
        Outline centred on the origin of the vehicle axes, m.
    curvature_preview, heading_preview : float
        How far ahead the driver reads the curvature and the direction of the path, s; it makes up for the car's delay.
    heading_gain : float
        Wheel angle per error of the heading.
    lateral_gain : float
        Wheel angle per distance from the path, rad/m.
    speed_gain, speed_integral : float
        Pedal per m/s, pedal per m.
    """

    speed: float
    wheelbase: float
    wheel_angle_max: float
    vehicle_length: float
    vehicle_width: float
    curvature_preview: float = 0.25
    heading_preview: float = 0.1
    heading_gain: float = 0.8
    lateral_gain: float = 0.05
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
        x, y, yaw, speed = (senses[name] for name in SENSES)
        curvature = self.course.path(x + s.curvature_preview * speed)[2]
        slope = self.course.path(x + s.heading_preview * speed)[1]
        angle = math.atan(s.wheelbase * curvature)
        angle += s.heading_gain * (math.atan(slope) - yaw) + s.lateral_gain * (self.course.path(x)[0] - y)
        steering = angle / s.wheel_angle_max
        error = s.speed - speed
        step, self._time = time - self._time, time
        pedal = s.speed_gain * error + s.speed_integral * self._integral
        if -1.0 < pedal < 1.0:
            self._integral += step * error
        return {
            "steering": min(max(steering, -1.0), 1.0),
            "throttle": min(max(pedal, 0.0), 1.0),
            "brake": min(max(-pedal, 0.0), 1.0),
        }


def make_driver(settings: Mapping[str, str], constants: Mapping[str, float]) -> Driver:
    """Driver from the ``[driver]`` section of a manoeuvre and the constants of the FMU.

    Parameters
    ----------
    settings : mapping of str to str
        ``course`` and the fields of `DriverSettings`; they take precedence over the constants of the FMU.
    constants : mapping of str to float
        Constants of the FMU by name; see `CONSTANTS`.

    Returns
    -------
    Driver

    Raises
    ------
    HostError
        If a setting is not known, no number, or missing both there and in the FMU.
    """
    numbers = {name: constants[constant] for name, constant in CONSTANTS.items() if constant in constants}
    known = {f.name for f in fields(DriverSettings)}
    for name, text in settings.items():
        if name == "course":
            continue
        if name not in known:
            raise HostError(f"[driver] has '{name}'; known are course, {', '.join(sorted(known))}.")
        try:
            numbers[name] = parse_number(text)
        except ValueError as error:
            raise HostError(f"[driver] {name}: {error}.") from None
        if numbers[name] < 0.0 or (numbers[name] == 0.0 and name in _POSITIVE):
            sign = "positive" if name in _POSITIVE else "zero or positive"
            raise HostError(f"[driver] {name} is {numbers[name]:g}; it must be {sign}.")
    if "speed" not in numbers or "course" not in settings:
        raise HostError("[driver] needs a course and a speed.")
    for name, constant in CONSTANTS.items():
        if name not in numbers:
            raise HostError(
                f"The driver needs the {name.replace('_', ' ')} of the car, which this FMU does not tell (it has no "
                f"constant '{constant}'); give it as --driver {name}=NUMBER, or in [driver] of the manoeuvre."
            )
    values = DriverSettings(**numbers)
    return Driver(course_of(settings["course"], values.vehicle_width), values)
