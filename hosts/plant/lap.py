"""A lap of the ring of the proving ground: `gymnasium.make("ali3/ProvingGroundLap-v0")`, and the driver on it."""

import math
from typing import Any

import numpy as np
from gymnasium import spaces

from hosts.common.arguments import positive
from hosts.common.errors import HostError
from hosts.common.world_files import make_world
from hosts.driving.driver import CONSTANTS
from hosts.driving.pilots.course_follower import CourseFollower, DriverSettings
from hosts.driving.planned_course import PlannedCourse
from hosts.plant.car import Car
from hosts.plant.environments import Floats, LaneEnvironment, number_pair
from hosts.plant.lane import Lane

# of the ring in `mbs/worlds/proving_ground.toml`
STRAIGHT = 640.0  # m
RADIUS = 60.0  # m, of the curves to the left
BEGIN = -20.0  # m, x of the begin of the first straight
WIDTH = 12.0  # m, of the road


def ring() -> Lane:
    """The centre line of the ring, closed, from the place `start` of the world on."""
    half = STRAIGHT + math.pi * RADIUS
    distance = (np.linspace(0.0, 2.0 * half, 831) - BEGIN) % (2.0 * half)
    along, back = distance % half, distance >= half
    angle = np.maximum(along - STRAIGHT, 0.0) / RADIUS
    x = np.minimum(along, STRAIGHT) + RADIUS * np.sin(angle)
    y = RADIUS * (1.0 - np.cos(angle))
    points = np.column_stack([np.where(back, STRAIGHT - x, x) + BEGIN, np.where(back, 2.0 * RADIUS - y, y)])
    points[-1] = points[0]
    return Lane(points, WIDTH)


class ProvingGroundLap(LaneEnvironment):
    """Drive a lap of the ring of the proving ground, 1657 m with a banked curve, a hill and a flat curve, to the left.

    Action: steering, -1 to 1, positive to the left; pedal, -1 the whole brake to 1 the whole throttle. Observation:
    offset from the middle of the road m, heading from its direction rad, speed m/s, yaw rate rad/s, sideslip rad,
    steering as it is now, curvature of the road at `AHEAD` 1/m. Reward a step: the way made along the road over 20 m/s,
    less the time, s; over a lap its sum is 82.8 s less the lap time, which `info["lap_time"]` has at its end. An
    episode ends with the lap, or where the middle of the car is beside the road or the solver refuses a step, either of
    which costs 20 s; it is truncated after `seconds`.

    Parameters
    ----------
    car : str
        As for `Car`.
    speed : (float, float)
        Range of the speed at the start, m/s.
    seconds : float
        After which an episode is truncated.
    road : str, optional
        A road file in place of that of the proving ground, which is made at the first use, in a quarter of a minute.
    """

    AHEAD = (5.0, 10.0, 20.0, 40.0, 60.0, 80.0, 110.0)
    PACE = 20.0  # m/s at which the reward is none
    OUT = 20.0  # s that an end before the lap costs

    def __init__(
        self,
        car: str = "prototype",
        speed: tuple[float, float] = (14.0, 16.0),
        seconds: float = 180.0,
        step: float = 0.02,
        road: str | None = None,
    ) -> None:
        self._speed = number_pair(speed, "speeds at the start")
        if road is None:
            road = str(make_world("proving_ground").road)
        plant = Car(car, step=step, inputs=("steering", "throttle", "brake"), parameters={"road.file": road})
        super().__init__(plant, ring(), seconds, largest=(20.0, 90.0))
        self.action_space = spaces.Box(-1.0, 1.0, (2,), np.float32)
        self._way = self.driven = 0.0

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Floats, dict[str, Any]]:
        """A flying start at x = 0; see `gymnasium.Env.reset`."""
        ranges = {"initial.speed": self._speed, "initial.y": (-0.3, 0.3), "initial.yaw": (-0.01, 0.01)}
        self._start(seed, options, **ranges)
        self.driven = 0.0
        observation = self._observation()
        self._way = self.lane.way
        return observation, {}

    def step(self, action: Floats) -> tuple[Floats, float, bool, bool, dict[str, Any]]:
        """A step; see `gymnasium.Env.step`."""
        self._steering, pedal = self._clipped_action(action).tolist()
        refused = self._advance(np.array([self._steering, max(pedal, 0.0), max(-pedal, 0.0)]))
        observation = self._observation()
        advance = math.remainder(self.lane.way - self._way, self.lane.length)
        before, self._way, self.driven = self.driven, self.lane.way, self.driven + advance
        info: dict[str, Any] = {"refused": refused} if refused else {}
        lap = self.driven >= self.lane.length
        if lap:  # the line is crossed within the step
            info["lap_time"] = (
                self.car.time - (self.driven - self.lane.length) / max(advance, 1e-9) * self.car.step_length
            )
        out = abs(float(observation[0])) > 0.5 * self.lane.width
        reward = (self.driven - before) / self.PACE - self.car.step_length - self.OUT * (out or bool(refused))
        return observation, reward, bool(lap or out or refused), self._steps >= self._most_steps, info


class LapDriver:
    """The driver of the manoeuvres, who holds a speed, on the lane of an environment.

    Parameters
    ----------
    environment : ProvingGroundLap
        Whose car he drives; he looks at its lane ahead.
    speed : float
        m/s.

    Raises
    ------
    HostError
        The car does not provide its dimensions.
    """

    def __init__(self, environment: ProvingGroundLap, speed: float) -> None:
        constants = environment.car.fmu.constants()
        if missing := [name for name in CONSTANTS.values() if name not in constants]:
            raise HostError(f"The driver needs constants that the car does not provide: {', '.join(missing)}.")
        dimensions = {name: constants[constant] for name, constant in CONSTANTS.items()}
        self.environment, lane = environment, environment.lane
        settings = DriverSettings(speed=positive(speed, "The speed of the driver", "m/s"), **dimensions)
        # In axes along the lane, as those of `act`, the lane is straight and only its curvature is left.
        course = PlannedCourse("lane", (), lambda x: (0.0, 0.0, float(lane.curvature(x))))
        self.driver = CourseFollower(course, settings)

    def act(self, seen: Floats) -> Floats:
        """The action for an observation."""
        offset, heading, speed = (float(value) for value in seen[:3])
        state = (self.environment.lane.way, offset, heading, speed)
        observation = dict(zip(("chassis.x", "chassis.y", "chassis.yaw", "speed"), state, strict=True))
        acts = self.driver.act(self.environment.car.time, observation)
        return np.array([acts["steering"], acts["throttle"] - acts["brake"]], np.float32)
