"""A pilot that drives a circle, and holds or changes the speed on it."""

import math
from collections.abc import Callable, Mapping
from dataclasses import InitVar, dataclass, field

from hosts.driving.ground_marks import Mark, circle
from hosts.driving.pilots.speed_holder import SpeedHolder

OBSERVED = ("chassis.x", "chassis.y", "chassis.yaw", "sideslip", "speed")
"""Outputs without which a circle cannot be held."""


@dataclass
class CircleFollower:
    """Steers the centre of mass along a circle that begins where the car stands, in the direction it moves.

    Notes
    -----
    The demanded curvature is that of the circle less feedback of the errors of direction and position and of the
    integral of the latter, with three equal poles at -1/`horizon` for a car that follows its front wheels at once.
    The sideslip is part of the direction of travel: a car that drifts is on its circle.
    """

    radius: float
    """Radius, m, positive: to the left, negative: to the right."""
    speed: InitVar[float | Callable[[float], float]]
    """Target speed, m/s, or as a function of the time, s."""
    wheelbase: float  # m
    wheel_angle_max: float
    """Mean angle of the front wheels where the input is 1, rad."""
    name: str = "steering"
    """Name of the input."""
    largest: float = 1.0
    """Largest magnitude of the input."""
    horizon: float = 1.0
    """Time constant of the correction of errors, s."""
    speed_holder: SpeedHolder = field(init=False)
    _centre: tuple[float, float] | None = field(default=None, init=False)
    _integral: float = field(default=0.0, init=False)
    _time: float = field(default=0.0, init=False)

    def __post_init__(self, speed: float | Callable[[float], float]) -> None:
        self.speed_holder = SpeedHolder(speed)

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
