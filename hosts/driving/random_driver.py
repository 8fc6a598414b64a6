"""A random driver: steps and sines of every control, sudden turns, and full speed towards ramps.

A seed determines the drive: inputs depend on numbers of `random.Random`, which are the same on all platforms, and on
outputs of the car.
"""

import math
import random
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass

from hosts.common.numbers import Value
from hosts.driving.pilots.pilot import OBSERVED

TOP_SPEED = 40.0
"""Speed above which the throttle is released and the brake applied, m/s."""


_STEERING = "steering_wheel_angle_demand"
_LOCK = 9.0  # rad, steering wheel angle at full lock


@dataclass(frozen=True)
class Target:
    """A target, such as a ramp."""

    x: float
    y: float
    """`x`, `y`: m."""
    yaw: float
    """Direction in which to drive over it, rad."""


class RandomDriver:
    """Inputs of a car over time, at random.

    Parameters
    ----------
    inputs : collection of str
        Inputs of the FMU, of which `steering` (or a demand in rad), `throttle`, `brake`, `hand_brake` and `selector`
        are used.
    targets : sequence of Target
        Targets of some of the actions.
    """

    def __init__(self, seed: int, inputs: Collection[str], targets: Sequence[Target] = ()) -> None:
        self._random = random.Random(seed)
        self._inputs = set(inputs)
        self._targets = list(targets)
        self._until = 0.0
        self._begin = 0.0
        self._action: Callable[[float, Mapping[str, float]], dict[str, float]] = self._roll
        self._numbers: list[float] = []
        self._target = Target(0.0, 0.0, 0.0)
        self._actions = [
            self._step,
            self._sine,
            self._flick,
            self._slam,
            self._spin,
            self._shift,
            self._noise,
            self._rush,
        ]

    def restart(self, time: float) -> None:
        """Begin the next action at a new start of the car. `time`: s."""
        self._until = time

    def act(self, time: float, observation: Mapping[str, float]) -> dict[str, float]:
        """Inputs for the step that begins at `time`.

        `time`: in s; `observation`: of `OBSERVED` those that the FMU has. Result: values of those of the five controls
        that the FMU has, within their ranges.
        """
        if time >= self._until:
            self._choose(time, observation)
        inputs = {"steering": 0.0, "throttle": 0.0, "brake": 0.0, "hand_brake": 0.0, "selector": 1.0}
        inputs |= self._action(time - self._begin, observation)
        if observation.get("speed", 0.0) > TOP_SPEED:
            inputs |= {"throttle": 0.0, "brake": max(inputs["brake"], 0.1)}
        if "steering" not in self._inputs and _STEERING in self._inputs:
            inputs[_STEERING] = _LOCK * inputs["steering"]
        return {name: value for name, value in inputs.items() if name in self._inputs}

    def _choose(self, time: float, observation: Mapping[str, float]) -> None:
        """Draw the next action, its numbers and its duration."""
        draw = self._random.random
        self._begin = time
        self._numbers = [draw() for _ in range(6)]
        drives_at_target = self._targets and set(OBSERVED) <= set(observation) and draw() < 0.4
        if drives_at_target:
            self._target = self._targets[int(draw() * len(self._targets))]
            self._action = self._aim
            self._until = time + 5.0 + 15.0 * draw()
            return
        self._action = self._actions[int(draw() * len(self._actions))]
        self._until = time + 0.3 + 3.7 * draw() ** 2

    def _roll(self, t: float, observation: Mapping[str, float]) -> dict[str, float]:
        return {}

    def _step(self, t: float, observation: Mapping[str, float]) -> dict[str, float]:
        """Steps of steering and one pedal."""
        a, b, c = self._numbers[:3]
        pedal = {"throttle": b} if c < 0.7 else {"brake": b}
        return {"steering": 2.0 * a - 1.0, **pedal}

    def _sine(self, t: float, observation: Mapping[str, float]) -> dict[str, float]:
        """Steering, throttle and brake in sines of 0.2 to 5 Hz."""
        a, b, c, d, _, _ = self._numbers
        phase = 2.0 * math.pi * (0.2 + 4.8 * b * b) * t
        push = math.sin(2.0 * math.pi * (0.2 + 3.0 * d) * t)
        return {"steering": a * math.sin(phase), "throttle": max(c * push, 0.0), "brake": max(-c * push, 0.0)}

    def _flick(self, t: float, observation: Mapping[str, float]) -> dict[str, float]:
        """Steering from lock to lock."""
        a, b, c = self._numbers[:3]
        side = 1.0 if a < 0.5 else -1.0
        return {"steering": side if t < 0.2 + 0.8 * b else -side, "throttle": c}

    def _slam(self, t: float, observation: Mapping[str, float]) -> dict[str, float]:
        """Full braking, straight or in a turn."""
        a, b = self._numbers[:2]
        return {"steering": (2.0 * a - 1.0) if b < 0.5 else 0.0, "brake": 1.0}

    def _spin(self, t: float, observation: Mapping[str, float]) -> dict[str, float]:
        """Hand brake in a turn, then full throttle."""
        a, b = self._numbers[:2]
        pulled = t < 0.4 + b
        return {"steering": 1.0 if a < 0.5 else -1.0, "hand_brake": float(pulled), "throttle": float(not pulled)}

    def _shift(self, t: float, observation: Mapping[str, float]) -> dict[str, float]:
        """Selector to reverse, neutral or drive at any speed."""
        a, b, c, d = self._numbers[:4]
        first, then = int(3.0 * a) - 1, int(3.0 * b) - 1
        return {"selector": float(first if t < 1.0 else then), "throttle": c, "steering": d - 0.5}

    def _noise(self, t: float, observation: Mapping[str, float]) -> dict[str, float]:
        """Other values in every step."""
        draw = self._random.random
        return {"steering": 2.0 * draw() - 1.0, "throttle": draw(), "brake": draw(), "hand_brake": draw()}

    def _rush(self, t: float, observation: Mapping[str, float]) -> dict[str, float]:
        """Full throttle, almost straight."""
        return {"throttle": 1.0, "steering": 0.2 * (self._numbers[0] - 0.5)}

    def _aim(self, t: float, observation: Mapping[str, float]) -> dict[str, float]:
        """Full throttle along the line through the target, after a detour if it cannot be met directly."""
        x, y, yaw, speed = (observation[name] for name in OBSERVED)
        direction = math.cos(self._target.yaw), math.sin(self._target.yaw)
        along = (x - self._target.x) * direction[0] + (y - self._target.y) * direction[1]
        across = (y - self._target.y) * direction[0] - (x - self._target.x) * direction[1]
        is_aligned = abs(across) < 3.0 and abs(_wrapped(yaw - self._target.yaw)) < 0.5
        point = along + 6.0 + 0.3 * speed if is_aligned or along < -10.0 - abs(across) else -30.0
        aim_point = self._target.x + point * direction[0], self._target.y + point * direction[1]
        turn = _wrapped(math.atan2(aim_point[1] - y, aim_point[0] - x) - yaw)
        slow = abs(turn) > 0.6 and speed > 12.0
        return {
            "steering": min(max(2.0 * turn / (1.0 + 0.05 * speed), -1.0), 1.0),
            "throttle": 0.0 if slow else 1.0,
            "brake": 0.5 if slow else 0.0,
        }


def random_start(seed: int, targets: Sequence[Target] = ()) -> dict[str, Value]:
    """Random start values of a car: mostly fast before a target, often in the air, sometimes far away.

    `targets`: half of the starts are 30 to 60 m before one of them, in its direction. Result: `initial.x`, `.y`, `.z`,
    `.yaw` and `.speed`: up to 1 m high, up to 40 m/s, and one in four up to 100 km from the origin along each axis.
    """
    generator = random.Random(f"start {seed}")
    draw = generator.random
    speed = TOP_SPEED * draw()
    height = draw() if draw() < 0.5 else 0.0
    if targets and draw() < 0.5:
        target = targets[int(draw() * len(targets))]
        distance = 30.0 + 30.0 * draw()
        x, y = target.x - distance * math.cos(target.yaw), target.y - distance * math.sin(target.yaw)
        yaw = target.yaw
    else:
        span = 1e5 if draw() < 0.5 else 50.0
        x, y, yaw = span * (2.0 * draw() - 1.0), span * (2.0 * draw() - 1.0), math.pi * (2.0 * draw() - 1.0)
    return {"initial.x": x, "initial.y": y, "initial.z": height, "initial.yaw": yaw, "initial.speed": speed}


def _wrapped(angle: float) -> float:
    """An angle between -pi and pi, rad."""
    return math.remainder(angle, 2.0 * math.pi)
