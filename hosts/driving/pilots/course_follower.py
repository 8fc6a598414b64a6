"""A pilot that follows a course with a view ahead, and holds the speed with throttle and brake."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from hosts.driving.course import Course
from hosts.driving.pilots.pilot import OBSERVED
from hosts.driving.pilots.speed_holder import SpeedHolder


@dataclass(frozen=True)
class DriverSettings:
    """Settings of a driver: speed, dimensions of the car and gains."""

    speed: float
    """Target speed, m/s."""
    wheelbase: float
    """m."""
    wheel_angle_max: float
    """Mean angle of the front wheels at full steering, rad."""
    vehicle_length: float
    vehicle_width: float
    """`vehicle_length`, `vehicle_width`: outline centred on the origin of the vehicle axes, m."""
    curvature_preview: float = 0.25
    heading_preview: float = 0.1
    """`curvature_preview`, `heading_preview`: preview times of curvature and direction of the path, s, which compensate
    the delay of the car."""
    heading_gain: float = 0.8
    """Wheel angle per error of the heading."""
    lateral_gain: float = 0.05
    """Wheel angle per distance from the path, rad/m."""
    speed_gain: float = 0.3
    speed_integral: float = 0.1
    """`speed_gain`, `speed_integral`: pedal per m/s, pedal per m."""


class CourseFollower:
    """Feedback from the position of the car to its steering and pedals."""

    def __init__(self, course: Course, settings: DriverSettings) -> None:
        self.course = course
        self.settings = settings
        self.speed_holder = SpeedHolder(settings.speed, settings.speed_gain, settings.speed_integral)

    def act(self, time: float, observation: Mapping[str, float]) -> dict[str, float]:
        """Inputs for the coming communication step.

        `time`: in s; `observation`: `OBSERVED`, SI units, earth axes. Result: `ACTS`.
        """
        s = self.settings
        x, y, yaw, speed = (observation[name] for name in OBSERVED)
        curvature = self.course.path(x + s.curvature_preview * speed)[2]
        slope = self.course.path(x + s.heading_preview * speed)[1]
        angle = math.atan(s.wheelbase * curvature)
        angle += s.heading_gain * (math.atan(slope) - yaw) + s.lateral_gain * (self.course.path(x)[0] - y)
        steering = angle / s.wheel_angle_max
        return {"steering": min(max(steering, -1.0), 1.0)} | self.speed_holder.act(time, observation)
