"""Environments of Gymnasium: `gymnasium.make("ali3/LaneKeeping-v0")`, `gymnasium.make("ali3/AntiLockBraking-v0")`."""

from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from ali3.message_text import brief
from hosts.common.arguments import array_of, mapping
from hosts.common.errors import HostError
from hosts.common.numbers import is_finite
from hosts.common.wheels import WHEELS
from hosts.driving.course import course_of
from hosts.fmu.fmu import StepRefusedError
from hosts.plant.car import Car
from hosts.plant.lane import Lane

Floats = NDArray[np.float32]


def number_pair(value: Any, subject: str) -> tuple[float, float]:
    """Two finite numbers from 0, else a `HostError`. `subject`: of its sentence, a plural."""
    pair = tuple(value) if isinstance(value, (tuple, list, np.ndarray)) else ()
    if len(pair) != 2 or not all(is_finite(number) and number >= 0.0 for number in pair):
        raise HostError(f"The {subject} of an environment are {brief(value)}; they must be two finite numbers from 0.")
    return float(pair[0]), float(pair[1])


class CarEnvironment(gymnasium.Env[Floats, Floats]):
    """Base of the environments: a car, its start and its step.

    The `options` of `reset` are parameters of this start as `Car.reset` takes them, in place of what is drawn:
    ``reset(options={"initial.speed": 15.0, "road.friction": (0.5, 0.9)})``. An episode that the car's solver refuses to
    go on with is terminated; `info["refused"]` then has its message.
    """

    def __init__(self, car: Car, output_names: tuple[str, ...], seconds: float) -> None:
        if not (is_finite(seconds) and seconds >= car.step_length):
            car.close()
            raise HostError(f"An episode has {brief(seconds)} s; it must be a number, and a step or more.")
        self.car, self._output_names = car, output_names
        self._most_steps = round(seconds / car.step_length)
        self._steps = 0
        self._outputs = np.zeros(len(output_names))

    def _start(self, seed: int | None, options: dict[str, Any] | None, **ranges: tuple[float, float]) -> None:
        """A start whose numbers are drawn by the generator of the environment."""
        parameters = mapping({} if options is None else options, "The options of a start")
        super().reset(seed=seed)
        self.car.reset(int(self.np_random.integers(2**31)), **ranges | dict(parameters))
        self._steps = 0
        self.car.read(self._output_names, self._outputs)

    def _clipped_action(self, action: Floats) -> NDArray[np.float64]:
        """An action, clipped to its space. Raises `HostError` before anything changes: it is no array of numbers."""
        box = self.action_space
        assert isinstance(box, spaces.Box)
        array = array_of(action)
        if array.shape != box.shape or not np.isfinite(array).all():
            raise HostError(f"The action is {brief(action)}; it must be {box.shape[0]} finite numbers, in an array.")
        clipped: NDArray[np.float64] = np.clip(array, box.low, box.high)
        return clipped

    def _advance(self, inputs: NDArray[np.float64]) -> str:
        """Make a step. Returns the message of the solver if it refuses the step, else an empty text."""
        self._steps += 1
        try:
            self.car.step(inputs)
        except StepRefusedError as error:
            return str(error)
        self.car.read(self._output_names, self._outputs)
        return ""

    def _clipped_observation(self, values: NDArray[np.float64]) -> Floats:
        """An observation, clipped to its space."""
        box = self.observation_space
        assert isinstance(box, spaces.Box)
        clipped: Floats = np.clip(values, box.low, box.high).astype(np.float32)
        return clipped

    def close(self) -> None:
        """Free the car."""
        self.car.close()


class LaneEnvironment(CarEnvironment):
    """Base of the environments on a lane: position of the car on it, and its curvature ahead.

    Observation: offset from the middle of the lane m, heading from its direction rad, speed m/s, yaw rate rad/s,
    sideslip rad, steering as it is now, curvature of the lane at `AHEAD` 1/m.
    """

    AHEAD: tuple[float, ...]

    def __init__(self, car: Car, lane: Lane, seconds: float, largest: tuple[float, float]) -> None:
        """`largest`: offset, m, and speed, m/s, of an observation."""
        super().__init__(car, ("chassis.x", "chassis.y", "chassis.yaw", "speed", "chassis.wz", "sideslip"), seconds)
        self.lane = lane
        high = np.array([largest[0], np.pi, largest[1], 10.0, np.pi, 1.0, *len(self.AHEAD) * [1.0]], np.float32)
        self.observation_space = spaces.Box(-high, high, dtype=np.float32)
        self._steering = 0.0

    def _start(self, seed: int | None, options: dict[str, Any] | None, **ranges: tuple[float, float]) -> None:
        super()._start(seed, options, **ranges)
        self.lane.forget()
        self._steering = 0.0

    def _observation(self) -> Floats:
        x, y, yaw, speed, yaw_rate, sideslip = self._outputs
        offset, heading, curvature = self.lane.sense(x, y, yaw, self.AHEAD)
        return self._clipped_observation(
            np.array([offset, heading, speed, yaw_rate, sideslip, self._steering, *curvature])
        )


class LaneKeeping(LaneEnvironment):
    """Keep the middle of the lane of a double lane change by the steering, at a speed that is held roughly.

    Action: steering, -1 to 1, positive to the left. Observation: offset from the middle of the lane m, heading from its
    direction rad, speed m/s, yaw rate rad/s, sideslip rad, steering as it is now, curvature 5, 15 and 25 m ahead 1/m.
    Reward a step: 1 less the square of the offset over a half lane, and less a hundredth of the square of the change of
    the steering. It ends beyond a half lane and is truncated after `seconds` or at the end of the lane.

    Parameters
    ----------
    car : str
        As for `Car`.
    speed : (float, float)
        Range of the speed at the start, m/s.
    seconds : float
        After which an episode is truncated.
    """

    AHEAD = (5.0, 15.0, 25.0)

    def __init__(
        self,
        car: str = "prototype",
        speed: tuple[float, float] = (12.0, 18.0),
        seconds: float = 8.0,
        step: float = 0.02,
    ) -> None:
        self._speed = number_pair(speed, "speeds at the start")
        plant = Car(car, step=step, inputs=("steering", "throttle"))
        width = plant.fmu.constants().get("vehicle.width", 1.6)
        super().__init__(plant, Lane.of_course(course_of("iso_3888_1", width), 200.0), seconds, largest=(5.0, 60.0))
        self.action_space = spaces.Box(-1.0, 1.0, (1,), np.float32)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Floats, dict[str, Any]]:
        """A start in the first lane; see `gymnasium.Env.reset`."""
        ranges = {"initial.speed": self._speed, "initial.y": (-0.3, 0.3), "initial.yaw": (-0.02, 0.02)}
        self._start(seed, options, **ranges)
        return self._observation(), {}

    def step(self, action: Floats) -> tuple[Floats, float, bool, bool, dict[str, Any]]:
        """A step; see `gymnasium.Env.step`."""
        steering, before = float(self._clipped_action(action)[0]), self._steering
        self._steering = steering
        throttle = min(max(0.3 * (0.5 * (self._speed[0] + self._speed[1]) - float(self._outputs[3])), 0.0), 1.0)
        refused = self._advance(np.array([steering, throttle]))
        observation = self._observation()
        share = float(observation[0]) / (0.5 * self.lane.width)
        reward = 1.0 - share**2 - 0.01 * (steering - before) ** 2
        out = abs(share) > 1.0
        ended = self._steps >= self._most_steps or self.lane.way >= self.lane.length - 1.0
        return observation, reward, bool(out or refused), bool(ended), {"refused": refused} if refused else {}


class AntiLockBraking(CarEnvironment):
    """Stop on a slippery road by the torques of the four brakes, straight and short.

    Action: share of the torque that a driver in need asks of the brake of each wheel, 0 to 1, in the order FL, FR, RL,
    RR. Observation: speed m/s, slip of the four wheels, rate of the four wheels rad/s, yaw rate rad/s, acceleration
    along the car m/s2. Reward a step: less the way, m, and less the square of the yaw angle, rad2. It ends when the car
    stands or is turned by more than half a radian, and is truncated after `seconds`.

    Parameters
    ----------
    car : str
        As for `Car`; an FMU must have the ports of the brakes by torque.
    speed, friction : (float, float)
        Ranges of the speed at the start, m/s, and of the friction of the road.
    torque : (float, float)
        Asked of a front and of a rear brake, N m.
    seconds : float
        After which an episode is truncated.
    """

    STANDING = 0.5  # m/s

    def __init__(
        self,
        car: str = "prototype",
        speed: tuple[float, float] = (20.0, 25.0),
        friction: tuple[float, float] = (0.3, 0.6),
        torque: tuple[float, float] = (650.0, 450.0),
        seconds: float = 15.0,
        step: float = 0.01,
    ) -> None:
        inputs = tuple(f"wheel_{w}.brake_torque_demand" for w in WHEELS)
        slips = tuple(f"wheel_{w}.slip" for w in WHEELS)
        rates = tuple(f"wheel_{w}.omega" for w in WHEELS)
        output_names = ("speed", *slips, *rates, "chassis.wz", "chassis.ax", "chassis.yaw")
        self._speed = number_pair(speed, "speeds at the start")
        self._friction = number_pair(friction, "frictions of the road")
        self._torque = np.repeat(number_pair(torque, "torques of the brakes"), 2)
        ports = None if Path(car).suffix.lower() == ".fmu" else "brakes"
        plant = Car(car, ports=ports, step=step, inputs=inputs, parameters={"selector": 0})
        super().__init__(plant, output_names, seconds)
        self.action_space = spaces.Box(0.0, 1.0, (4,), np.float32)
        high = np.array([100.0, *4 * [10.0], *4 * [200.0], 20.0, 60.0], np.float32)
        self.observation_space = spaces.Box(-high, high, dtype=np.float32)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Floats, dict[str, Any]]:
        """A start at speed with free wheels; see `gymnasium.Env.reset`."""
        self._start(seed, options, **{"initial.speed": self._speed, "road.friction": self._friction})
        return self._observation(), {}

    def step(self, action: Floats) -> tuple[Floats, float, bool, bool, dict[str, Any]]:
        """A step; see `gymnasium.Env.step`."""
        refused = self._advance(self._clipped_action(action) * self._torque)
        speed, yaw = self._outputs[0], self._outputs[11]
        reward = -float(speed) * self.car.step_length - float(yaw) ** 2
        ended = speed < self.STANDING or abs(yaw) > 0.5
        info = {"refused": refused} if refused else {}
        return self._observation(), reward, bool(ended or refused), self._steps >= self._most_steps, info

    def _observation(self) -> Floats:
        return self._clipped_observation(self._outputs[:11])


for _name, _module, _function in (
    ("LaneKeeping", "environments", "lane_keeping"),
    ("AntiLockBraking", "environments", "anti_lock_braking"),
    ("ProvingGroundLap", "lap", "proving_ground_lap"),
):
    gymnasium.register(
        f"ali3/{_name}-v0",
        entry_point=f"hosts.plant.{_module}:{_name}",
        vector_entry_point=f"hosts.plant.vector_environment:{_function}",
    )
