"""A linear bicycle model, integrated, with the interface of `TestedCar`."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from hosts.catalogue.car import CarFacts, Pilot, TestedCar
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.result import Result
from hosts.fmu.fmu_source import FmuSource

INPUTS = ("steering_wheel_angle_demand", "throttle", "brake")
OUTPUTS = (
    *("chassis.x", "chassis.y", "chassis.yaw", "chassis.roll", "chassis.ay", "chassis.wz", "speed", "sideslip"),
    *("steering_wheel_angle", "wheel_FL.steer", "wheel_FR.steer"),
)


@dataclass(frozen=True)
class BicycleCar(TestedCar):
    """Mass, axles and cornering stiffnesses, SI units; rolls by `roll` rad per m/s2 and at once.

    `excess` is added to the stiffness of the front axle in turns to the right, as a share.
    """

    label: str = "bicycle"
    fmu: FmuSource = field(default_factory=lambda: FmuSource(Path("bicycle.fmu")))
    step: float = 0.01
    mass: float = 1200.0
    inertia: float = 1600.0
    front: float = 1.1
    rear: float = 1.4
    front_stiffness: float = 90e3
    rear_stiffness: float = 95e3
    ratio: float = 16.0
    roll: float = 0.008
    excess: float = 0.0
    push: float = 6.0

    @property
    def wheelbase(self) -> float:
        return self.front + self.rear

    def understeer(self, excess: float = 0.0) -> float:
        """Understeer gradient on paper, rad s2/m."""
        front = self.front_stiffness * (1.0 + excess)
        return self.mass / self.wheelbase * (self.rear / front - self.front / self.rear_stiffness)

    @property
    def facts(self) -> CarFacts:  # type: ignore[override]
        return CarFacts(INPUTS, OUTPUTS, ("initial.speed",), {}, {"vehicle.wheelbase": self.wheelbase}, self.step)

    def drive(
        self,
        manoeuvre: Manoeuvre,
        pilot: Pilot | None = None,
        until: Callable[[float, Mapping[str, float]], bool] | None = None,
        record_step: float | None = None,
    ) -> Result:
        assert pilot is not None
        state = np.array([0.0, 0.0, 0.0, 0.0, 0.0, float(manoeuvre.start["initial.speed"])])
        act, time, rows = dict.fromkeys(INPUTS, 0.0), [], []
        for k in range(round(manoeuvre.stop_time / self.step) + 1):
            observation = self._senses(state, act)
            time.append(k * self.step)
            if until is not None and k and until(k * self.step, observation):
                rows.append([*act.values(), *observation.values()])
                break
            act = act | pilot.act(k * self.step, observation)
            rows.append([*act.values(), *observation.values()])
            state = self._step(state, act)
        names = [*INPUTS, *OUTPUTS]
        units = dict.fromkeys(names, "1")
        return Result(names, units, np.array(time), np.array(rows), 0.0, time[-1], 0, [])

    def _step(self, state: np.ndarray, act: Mapping[str, float]) -> np.ndarray:
        """Runge-Kutta of order four."""
        h = self.step
        a = self._rate(state, act)[0]
        b = self._rate(state + 0.5 * h * a, act)[0]
        c = self._rate(state + 0.5 * h * b, act)[0]
        d = self._rate(state + h * c, act)[0]
        return state + h / 6.0 * (a + 2.0 * b + 2.0 * c + d)

    def _rate(self, state: np.ndarray, act: Mapping[str, float]) -> tuple[np.ndarray, float]:
        """Rates of x, y, yaw, lateral speed, yaw rate, forward speed; and the lateral acceleration."""
        _, _, yaw, lateral, turn, speed = state
        steer = act["steering_wheel_angle_demand"] / self.ratio
        front = self.front_stiffness * (1.0 + (self.excess if steer < 0.0 else 0.0))
        of_front = front * (steer - (lateral + self.front * turn) / speed)
        of_rear = self.rear_stiffness * (self.rear * turn - lateral) / speed
        ay = (of_front + of_rear) / self.mass
        rate = (
            speed * math.cos(yaw) - lateral * math.sin(yaw),
            speed * math.sin(yaw) + lateral * math.cos(yaw),
            turn,
            ay - speed * turn,
            (self.front * of_front - self.rear * of_rear) / self.inertia,
            self.push * act["throttle"] - 9.0 * act["brake"] - 5e-4 * speed**2,
        )
        return np.array(rate), ay

    def _senses(self, state: np.ndarray, act: Mapping[str, float]) -> dict[str, float]:
        x, y, yaw, lateral, turn, speed = map(float, state)
        ay = self._rate(state, act)[1]
        wheel = act["steering_wheel_angle_demand"]
        angle = wheel / self.ratio
        sideslip = math.atan2(lateral, speed)
        values = (x, y, yaw, self.roll * ay, ay, turn, math.hypot(speed, lateral), sideslip, wheel, angle, angle)
        return dict(zip(OUTPUTS, values, strict=True))
