"""A pilot that accelerates on a straight and then drives a course that begins at the position of the car."""

import math
from collections import ChainMap
from collections.abc import Callable, Mapping
from dataclasses import astuple

from hosts.driving.course import Course
from hosts.driving.ground_marks import Mark, lanes
from hosts.driving.pilots.pilot import Pilot
from hosts.driving.pilots.speed_holder import SpeedHolder


class RunUpPilot:
    """Drives straight until the speed is reached; the course then begins at the pose of the car.

    Parameters
    ----------
    steering : Pilot
        Steers along a course in axes at the pose of the car when it begins, x along its heading.
    speed : float
        Target, m/s.
    begins : callable
        Function of time and observation; the course begins at the first time at which it is true.
    release_at : float
        Position along x from which on throttle and brake are released, m; infinite: never.

    Attributes
    ----------
    start : float
        When the course begins, s; NaN while it has not.
    pose : tuple of float
        x, y, yaw of the course's axes, earth, m and rad.
    """

    def __init__(
        self,
        steering: Pilot,
        speed: float,
        begins: Callable[[float, Mapping[str, float]], bool],
        release_at: float = math.inf,
    ) -> None:
        self.steering = steering
        self.begins = begins
        self.release_at = release_at
        self.start = math.nan
        self.pose = (0.0, 0.0, 0.0)
        self.released = False
        self._speed_holder = SpeedHolder(speed, gain=1.0, integral_gain=1.0)

    @property
    def marks(self) -> list[Mark]:
        """Lanes of the course, once it has begun."""
        course: Course | None = getattr(self.steering, "course", None)
        return (
            []
            if course is None or math.isnan(self.start)
            else [lanes([astuple(gate) for gate in course.gates], self.pose)]
        )

    def act(self, time: float, observation: Mapping[str, float]) -> dict[str, float]:
        pedals = {"brake": 0.0, **self._speed_holder.act(time, observation)}
        if math.isnan(self.start):
            if not self.begins(time, observation):
                return {"steering": 0.0, **pedals}
            self.start = time
            self.pose = (observation["chassis.x"], observation["chassis.y"], observation["chassis.yaw"])
        x, y, yaw = self.pose_on_course(observation)
        self.released = self.released or x >= self.release_at
        if self.released:
            pedals = {"throttle": 0.0, "brake": 0.0}
        here = ChainMap({"chassis.x": x, "chassis.y": y, "chassis.yaw": yaw}, observation)  # type: ignore[arg-type]
        return {**self.steering.act(time, here), **pedals}

    def pose_on_course(self, observation: Mapping[str, float]) -> tuple[float, float, float]:
        """Position and heading of the car in the axes of the course, m and rad."""
        x0, y0, yaw0 = self.pose
        dx, dy = observation["chassis.x"] - x0, observation["chassis.y"] - y0
        turned = math.remainder(observation["chassis.yaw"] - yaw0, 2.0 * math.pi)
        return (math.cos(yaw0) * dx + math.sin(yaw0) * dy, math.cos(yaw0) * dy - math.sin(yaw0) * dx, turned)
