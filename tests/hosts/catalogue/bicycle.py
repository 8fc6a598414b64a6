"""A linear bicycle model as a car of the catalogue, so that every result is known in closed form."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.signal import StateSpace, cont2discrete

from hosts.catalogue.car import CarFacts, TestedCar
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.pilots.pilot import Pilot
from hosts.driving.result import Result
from hosts.fmu.fmu_source import FmuSource

MASS = 1500.0  # kg
INERTIA = 2500.0  # kg m2
FRONT = 1.2  # m, from the centre of mass to the axle
REAR = 1.5  # m
STIFF_FRONT = 90e3  # N/rad
STIFF_REAR = 110e3  # N/rad
RATIO = 16.0  # steering wheel to road wheels
ROLL_PER_ACCELERATION = 0.01
OUTPUTS = ("chassis.wz", "chassis.ay", "sideslip", "chassis.roll", "speed")


def bicycle(speed: float) -> StateSpace:
    """Transfer functions from the steering wheel angle, rad, to yaw rate, lateral acceleration and sideslip angle."""
    c0, c1 = STIFF_FRONT, STIFF_REAR
    a = np.array(
        [
            [-(c0 + c1) / (MASS * speed), (c1 * REAR - c0 * FRONT) / (MASS * speed**2) - 1.0],
            [(c1 * REAR - c0 * FRONT) / INERTIA, -(c0 * FRONT**2 + c1 * REAR**2) / (INERTIA * speed)],
        ]
    )
    b = np.array([[c0 / (MASS * speed)], [c0 * FRONT / INERTIA]]) / RATIO
    slip_rate, yaw = a[0], np.array([0.0, 1.0])
    return StateSpace(a, b, [yaw, speed * (slip_rate + yaw), [1.0, 0.0]], [[0.0], [speed * b[0, 0]], [0.0]])


@dataclass(frozen=True)
class BicycleCar(TestedCar):
    """The car."""

    label: str = "bicycle"
    fmu: FmuSource = field(default_factory=lambda: FmuSource(Path("bicycle.fmu")))
    """None is read."""
    step: float | None = 0.01
    steered_by: str = "steering_wheel_angle_demand"
    """Its input."""
    told: Mapping[str, float] = field(default_factory=dict)
    """Constants."""
    top_speed: float = 60.0
    """Speed at full throttle, m/s."""
    strongest: float = math.inf
    """Lateral acceleration at which tyres slide: the angle has no more effect beyond, m/s²."""
    turn_right: float = 1.0
    """Factor on the angle of turns to the right."""
    refuses_after: float = math.inf
    """Time at which a step is refused, s."""
    from_rest: float = 0.0
    """Speed of the lateral motion, m/s, of a car that begins at rest and has no start value of it; 0: it has one."""
    factors: Mapping[str, float] = field(default_factory=dict)
    """On outputs, as a wrong alias file has them."""
    shown: tuple[str, ...] = OUTPUTS
    """Its outputs."""

    @property
    def facts(self) -> CarFacts:  # type: ignore[override]
        """See `TestedCar.facts`."""
        inputs = frozenset({self.steered_by, "throttle", "brake"})
        start: frozenset[str] = frozenset() if self.from_rest else frozenset({"initial.speed"})
        return CarFacts(inputs, frozenset(self.shown), start, {}, self.told, float(self.step or 0.01))

    def drive(
        self,
        manoeuvre: Manoeuvre,
        pilot: Pilot | None = None,
        until: Callable[[float, Mapping[str, float]], bool] | None = None,
        record_step: float | None = None,
    ) -> Result:
        """See `TestedCar.drive`; the lateral motion is that of the speed at the start."""
        assert pilot is not None
        assert until is not None
        step, speed = self.facts.step, 0.0 if self.from_rest else float(manoeuvre.start["initial.speed"])
        system = bicycle(self.from_rest or speed)
        a, b, c, d, _ = cont2discrete((system.A, system.B, system.C, system.D), step)
        full = self.told.get("vehicle.steering_wheel_angle_max", 1.0)
        per_input = full if self.steered_by == "steering" else 1.0
        gain = float((system.D - system.C @ np.linalg.solve(system.A, system.B))[1, 0])
        x, drag = np.zeros(2), 4.0 / self.top_speed**2
        speed = min(speed, self.top_speed)
        observation = dict.fromkeys(OUTPUTS, 0.0) | {"speed": speed}
        acts = {self.steered_by: 0.0, "throttle": 0.0, "brake": 0.0}
        rows, failed = [[*acts.values(), *observation.values()]], 0
        for k in range(round(manoeuvre.stop_time / step)):
            acts |= pilot.act(k * step, observation)
            rows[-1][: len(acts)] = acts.values()  # a row has the inputs with which the next step begins
            if k * step > self.refuses_after:
                failed = 1
                break
            angle = per_input * acts[self.steered_by]
            angle *= self.turn_right if angle < 0.0 else 1.0
            now = float(np.clip(angle, -self.strongest / gain, self.strongest / gain))
            x = a @ x + b[:, 0] * now
            yaw_rate, acceleration, slip = c @ x + d[:, 0] * now
            speed += step * (4.0 * acts["throttle"] - 9.0 * acts["brake"] - drag * speed**2)
            roll = ROLL_PER_ACCELERATION * acceleration
            observation = dict(zip(OUTPUTS, map(float, (yaw_rate, acceleration, slip, roll, speed)), strict=True))
            rows.append([*acts.values(), *observation.values()])
            if until((k + 1) * step, observation):
                break
        names = [*acts, *OUTPUTS]
        kept = [names.index(n) for n in (*acts, *self.shown)]
        time = step * np.arange(len(rows))
        values = (np.array(rows) * [self.factors.get(n, 1.0) for n in names])[:, kept]
        return Result([names[k] for k in kept], {}, time, values, 0.0, float(time[-1]), failed, [])


def gains(speed: float) -> NDArray[np.float64]:
    """Steady yaw rate, lateral acceleration and sideslip angle over the steering wheel angle."""
    s = bicycle(speed)
    return np.asarray((s.D - s.C @ np.linalg.solve(s.A, s.B))[:, 0])


def mode(speed: float) -> tuple[float, float]:
    """Natural frequency, rad/s, and damping ratio."""
    a = bicycle(speed).A
    w = math.sqrt(float(np.linalg.det(a)))
    return w, -float(np.trace(a)) / (2.0 * w)
