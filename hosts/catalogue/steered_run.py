"""A run in which the car is brought to its speed, and then steered by a table."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from hosts.catalogue.car import TestedCar
from hosts.catalogue.preparation import start_at
from hosts.catalogue.steering import SteeringInput
from hosts.catalogue.stop_conditions import ROLLED
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.pilots.speed_holder import SpeedHolder
from hosts.driving.result import Result
from hosts.measures.filters import resample

_CLOSE = 0.1
_NEAR = 0.5
_COAST_FROM = 0.7
_INTERVAL = 0.005
_REACHED = 0.97


class Pedals(Enum):
    """Pedals after the steering begins."""

    HOLD_SPEED = "speed is held"
    FIXED = "pedals are held"
    COAST = "throttle is let go before"


class SteeredPilot:
    """Holds the speed until the car runs steadily, then steers by a table.

    `speed`: when the steering begins, m/s; `time`, `angle`: s from the beginning, and angle of the steering wheel, rad;
    linear in between, shape (n,); `longest`: time the car has to come to its speed, s. `begin`: when the steering
    began, s; NaN while it has not; `gave_up`: whether the car did not come to its speed.
    """

    def __init__(
        self,
        car: TestedCar,
        speed: float,
        time: NDArray[np.float64],
        angle: NDArray[np.float64],
        pedals: Pedals,
        longest: float,
    ) -> None:
        self.speed, self.pedals, self.longest = speed, pedals, longest
        self.input = SteeringInput.of(car.facts)
        self.time, self.values = time, angle * self.input.per_radian
        self.begin = math.nan
        self.gave_up = False
        approach = speed + (_COAST_FROM if pedals is Pedals.COAST else 0.0)
        self._holder = SpeedHolder(approach, brakes="brake" in car.facts.inputs)
        self._approach = approach
        self._steady_since = 0.0
        self._coasting = False
        self._acts: dict[str, float] = {}

    def act(self, time: float, observation: Mapping[str, float]) -> dict[str, float]:
        if not math.isfinite(self.begin):
            self._approaching(time, observation["speed"])
        if not self._coasting and (not math.isfinite(self.begin) or self.pedals is Pedals.HOLD_SPEED):
            self._acts = self._holder.act(time, observation)
        angle = float(np.interp(time - self.begin, self.time, self.values)) if math.isfinite(self.begin) else 0.0
        return self._acts | {self.input.name: angle}

    def _approaching(self, time: float, speed: float) -> None:
        if self._coasting:
            if speed <= self.speed:
                self.begin = time
        else:
            # a car whose gearbox hunts is good enough after a while: standards allow 2 km/h
            close = _CLOSE if time < 0.6 * self.longest else _NEAR
            if abs(speed - self._approach) > close:
                self._steady_since = time
            if time - self._steady_since >= 1.0:
                if self.pedals is Pedals.COAST:
                    self._coasting = True
                    self._acts = dict.fromkeys(self._acts, 0.0)
                else:
                    self.begin = time
        self.gave_up = not math.isfinite(self.begin) and time > self.longest

    def ends(self, time: float, observation: Mapping[str, float]) -> bool:
        """Whether the run is over: the table is at its end, the car gave up or lies on its side."""
        return self.gave_up or time >= self.begin + self.time[-1] or abs(observation.get("chassis.roll", 0.0)) > ROLLED


@dataclass(frozen=True)
class SteeredRun:
    """Signals of a steered run at equally spaced times; 0 is the begin of the steering."""

    result: Result
    """As recorded, with rows at least 5 ms apart or each step."""
    begin: float
    """Of the steering in its time, s; NaN if the car did not come to its speed."""
    time: NDArray[np.float64]
    """Shape (n,), s; from 1 s before the beginning or later. Empty if there was none."""
    steering: NDArray[np.float64]
    yaw_rate: NDArray[np.float64]
    acceleration: NDArray[np.float64]
    sideslip: NDArray[np.float64]
    roll: NDArray[np.float64]
    speed: NDArray[np.float64]
    """`steering`, `yaw_rate`, `acceleration`, `sideslip`, `roll`, `speed`: in rad, rad/s, m/s², rad, rad, m/s; NaN
    where the car has no such output. The acceleration is lateral and level. Shape (n,) each."""
    whole: bool
    """Whether the table was driven to its end."""

    def shortfall(self, amplitude: float) -> str:
        """A sentence where the steering wheel did not come to an angle, rad, that was asked for; else empty."""
        reached = float(np.abs(self.steering).max()) if len(self.steering) else math.nan
        if not reached < _REACHED * amplitude:
            return ""
        return (
            f"The steering wheel came to {math.degrees(reached):.3g}° where {math.degrees(amplitude):.3g}° were asked "
            "for: the car's own steering is slower."
        )

    @property
    def interval(self) -> float:
        """Between samples, s."""
        return float(self.time[1] - self.time[0])

    def thinned(self, interval: float = 0.02) -> Result:
        """The record from 1 s before the steering begins, with rows no closer than an interval, s."""
        r = self.result
        step = float(r.time[1] - r.time[0]) if len(r.time) > 1 else interval
        first = int(np.searchsorted(r.time, self.begin - 1.0 - 1e-9)) if math.isfinite(self.begin) else 0
        rows = np.arange(first, len(r.time), max(1, math.floor(interval / step + 1e-9)))
        return replace(r, time=r.time[rows], values=r.values[rows])


def steer(
    car: TestedCar,
    name: str,
    speed: float,
    time: NDArray[np.float64],
    angle: NDArray[np.float64],
    pedals: Pedals,
    lateral_limit: float = math.inf,
) -> SteeredRun:
    """Bring the car to its speed on a straight line and steer it.

    `speed`: in m/s; `time`, `angle`: in s from the beginning, rad, shape (n,); `lateral_limit`: lateral acceleration at
    which the run ends, m/s².
    """
    start = start_at(car, speed + (_COAST_FROM if pedals is Pedals.COAST else 0.0))
    longest = 30.0 if start else 90.0
    pilot = SteeredPilot(car, speed, time, angle, pedals, longest)
    manoeuvre = Manoeuvre(
        name,
        np.zeros(1),
        dict.fromkeys([pilot.input.name, "throttle"], np.zeros(1)),
        longest + float(time[-1]) + 2.0 * car.facts.step,
        start,
    )

    def ends(t: float, observation: Mapping[str, float]) -> bool:
        return pilot.ends(t, observation) or abs(observation["chassis.ay"]) > lateral_limit

    result = car.drive(manoeuvre, pilot, ends, _INTERVAL)
    return _signals(result, pilot, car.facts.step)


def level_acceleration(result: Result) -> NDArray[np.float64]:
    """Lateral acceleration in the plane of the road, m/s²: that along the vehicle's y axis, less the body's roll."""
    ay = result["chassis.ay"]
    if "chassis.roll" not in result or "chassis.az" not in result:
        return ay
    roll = result["chassis.roll"]
    return np.asarray(ay * np.cos(roll) - result["chassis.az"] * np.sin(roll))


def _signals(result: Result, pilot: SteeredPilot, step: float) -> SteeredRun:
    none = np.zeros(0)
    if not math.isfinite(pilot.begin) or len(result.time) < 3 or result.time[-1] <= pilot.begin:
        return SteeredRun(result, math.nan, none, none, none, none, none, none, none, False)
    row = float(result.time[1] - result.time[0])
    interval = max(_INTERVAL, row)
    # the grid has a sample where the steering begins
    first = pilot.begin - interval * math.floor(min(1.0, pilot.begin) / interval)
    selected = result.time > first - 1.5 * row
    time, blank = result.time[selected], np.full(len(result.time), math.nan)
    grid = resample(time, time, interval, first)[0]

    def even(values: NDArray[np.float64]) -> NDArray[np.float64]:
        if not np.isfinite(values[selected]).all():
            return np.full(len(grid), math.nan)
        return resample(time, values[selected], interval, first)[1]

    names = ("chassis.wz", "sideslip", "chassis.roll", "speed")
    yaw_rate, sideslip, roll, speed = (even(result.continuous(n) if n in result else blank) for n in names)
    return SteeredRun(
        result,
        pilot.begin,
        grid - pilot.begin,
        even(pilot.input.measured(result, step)),
        yaw_rate,
        even(level_acceleration(result)),
        sideslip,
        roll,
        speed,
        not result.failed_steps and bool(result.time[-1] >= pilot.begin + pilot.time[-1] - 1.5 * row),
    )
