"""A pilot that drives a circle, and holds or changes the speed on it."""

import math
from collections.abc import Callable, Mapping

from hosts.driving.ground_marks import Mark, circle
from hosts.driving.pilots.speed_holder import SpeedHolder

OBSERVED = ("chassis.x", "chassis.y", "chassis.yaw", "sideslip", "speed")
"""Outputs without which a circle cannot be held."""


class CircleFollower:
    """Steers the centre of mass along a circle that begins where the car stands, in the direction it moves.

    Parameters
    ----------
    radius : float
        m, positive: to the left, negative: to the right.
    speed : float or callable
        Target speed, m/s, or as a function of the time, s.
    wheelbase : float
        m.
    wheel_angle_max : float
        Mean angle of the front wheels where the input is 1, rad.
    horizon : float
        Time constant of the correction of errors, s.

    Notes
    -----
    The demanded curvature is that of the circle less feedback of the errors of direction and position and of the
    integral of the latter, with three equal poles at -1/`horizon` for a car that follows its front wheels at once.
    The sideslip is part of the direction of travel: a car that drifts is on its circle.
    """

    def __init__(
        self,
        radius: float,
        speed: float | Callable[[float], float],
        wheelbase: float,
        wheel_angle_max: float,
        name: str = "steering",
        largest: float = 1.0,
        horizon: float = 1.0,
    ) -> None:
        self.radius = radius
        self.wheelbase = wheelbase
        self.wheel_angle_max = wheel_angle_max
        self.name = name
        self.largest = largest
        self.horizon = horizon
        self.speed_holder = SpeedHolder(speed)
        self._centre: tuple[float, float] | None = None
        self._integral = 0.0
        self._time = 0.0

    def offset(self, observation: Mapping[str, float]) -> float:
        """Distance of the car to the left of the circle, m; zero before the first act."""
        if self._centre is None:
            return 0.0
        distance = math.hypot(observation["chassis.x"] - self._centre[0], observation["chassis.y"] - self._centre[1])
        return math.copysign(abs(self.radius) - distance, self.radius * (abs(self.radius) - distance))

    @property
    def marks(self) -> list[Mark]:
        """The circle, once it is known."""
        return [] if self._centre is None else [circle(self._centre, abs(self.radius))]

    def act(self, time: float, observation: Mapping[str, float]) -> dict[str, float]:
        """See `hosts.driving.pilots.pilot.Pilot.act`; steering, throttle and brake from `OBSERVED`."""
        x, y, yaw, sideslip, speed = (observation[name] for name in OBSERVED)
        travel = yaw + sideslip
        if self._centre is None:
            self._centre = (x - self.radius * math.sin(travel), y + self.radius * math.cos(travel))
        step, self._time = time - self._time, time
        centre_x, centre_y = self._centre
        side = math.copysign(1.0, self.radius)
        tangent = math.atan2(side * (x - centre_x), -side * (y - centre_y))
        direction_error = math.remainder(travel - tangent, 2.0 * math.pi)
        offset = self.offset(observation)
        length = self.horizon * max(speed, 1.0)
        curvature = 1.0 / self.radius - 3.0 * direction_error / length - 3.0 * offset / length**2
        curvature -= self._integral / length**2 / self.horizon
        steering = math.atan(self.wheelbase * curvature) / self.wheel_angle_max
        if abs(steering) < self.largest:
            self._integral += step * offset
        limited = min(max(steering, -self.largest), self.largest)
        return {self.name: limited} | self.speed_holder.act(time, observation)
