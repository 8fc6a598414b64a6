"""A pilot that steers along a course by its direction of travel."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from hosts.driving.course import Course


@dataclass(frozen=True)
class LineFollower:
    """Steers the centre of mass along the line of a course.

    Notes
    -----
    The demanded curvature is that of the line less feedback of the errors of direction and position, with two equal
    poles at -1/`horizon` for a car that follows its front wheels at once. The sideslip is part of the direction of
    travel where the car reports it.
    """

    course: Course
    wheelbase: float  # m
    wheel_angle_max: float
    """Mean angle of the front wheels where the input is 1, rad."""
    preview: float = 0.2
    """Preview time of the curvature of the line, s, which compensates the delay of the car."""
    horizon: float = 0.5
    """Time constant of the correction of errors, s."""
    lead: float = 0.3
    """Errors are extrapolated by this time, s."""

    def act(self, time: float, observation: Mapping[str, float]) -> dict[str, float]:
        """See `hosts.driving.pilots.pilot.Pilot.act`; steering only."""
        x, y, speed = observation["chassis.x"], observation["chassis.y"], observation["speed"]
        travel = observation["chassis.yaw"] + observation.get("sideslip", 0.0)
        course_y, slope, course_curvature = self.course.path(x)
        heading_error = math.remainder(travel - math.atan(slope), 2.0 * math.pi)
        offset = (y - course_y) * math.cos(math.atan(slope))
        # both errors are extrapolated to the response of the car
        offset += self.lead * speed * heading_error
        if "chassis.wz" in observation:
            heading_error += self.lead * (observation["chassis.wz"] - speed * course_curvature)
        length = self.horizon * max(speed, 1.0)
        curvature = self.course.path(x + self.preview * speed * math.cos(travel))[2]
        curvature -= 2.0 * heading_error / length + offset / length**2
        steering = math.atan(self.wheelbase * curvature) / self.wheel_angle_max
        return {"steering": min(max(steering, -1.0), 1.0)}
