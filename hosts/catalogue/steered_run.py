"""Runs in which the car approaches a speed, and is then steered by a table."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from hosts.catalogue.car import TestedCar
from hosts.catalogue.preparation import ROLLED, start_at_speed
from hosts.catalogue.steering import SteeringInput
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.pilots.speed_holder import SpeedHolder
from hosts.driving.result import Result
from hosts.measures.filters import resample

_SPEED_TOLERANCE = 0.1  # m/s
_LATE_SPEED_TOLERANCE = 0.5  # m/s, after 60 % of the time of the approach
_COAST_FROM = 0.7  # m/s above the speed of the steering
_INTERVAL = 0.005  # s
_MIN_FRACTION = 0.97  # of a requested angle
_ROUND_OFF = 1e-9


class Pedals(Enum):
    """Pedals since the start of the steering."""

    HOLD_SPEED = "speed is held"
    FIXED = "pedals are held"
    COAST = "throttle is let go before"


class SteeredPilot:
    """A pilot that holds the speed until the car runs steadily, then steers by a table.

    `speed`: speed at the start of the steering, m/s; `time`, `angle`: table of the steering-wheel angle, s from the
    start and rad, shape (n,), linear in between; `max_approach`: longest time of the approach, s. `steering_start`:
    start of the steering, s; NaN before it; `gave_up`: whether the approach took too long.
    """

    def __init__(
        self,
        car: TestedCar,
        speed: float,
        time: NDArray[np.float64],
        angle: NDArray[np.float64],
        pedals: Pedals,
        max_approach: float,
    ) -> None:
        self.speed, self.pedals, self.max_approach = speed, pedals, max_approach
        self.input = SteeringInput.of(car.facts)
        self.time, self.values = time, angle * self.input.per_radian
        self.steering_start = math.nan
        self.gave_up = False
        approach_speed = speed + (_COAST_FROM if pedals is Pedals.COAST else 0.0)
        self._holder = SpeedHolder(approach_speed, brakes="brake" in car.facts.inputs)
        self._approach_speed = approach_speed
        self._steady_since = 0.0
        self._coasting = False
        self._pedal_inputs: dict[str, float] = {}

    @property
    def is_steering(self) -> bool:
        """Whether the steering has started."""
        return math.isfinite(self.steering_start)

    def act(self, time: float, observation: Mapping[str, float]) -> dict[str, float]:
        if not self.is_steering:
            self._update_approach(time, observation["speed"])
        if not self._coasting and (not self.is_steering or self.pedals is Pedals.HOLD_SPEED):
            self._pedal_inputs = self._holder.act(time, observation)
        angle = float(np.interp(time - self.steering_start, self.time, self.values)) if self.is_steering else 0.0
        return self._pedal_inputs | {self.input.name: angle}

    def _update_approach(self, time: float, speed: float) -> None:
        if self._coasting:
            if speed <= self.speed:
                self.steering_start = time
        else:
            # For a car with frequent gear changes the tolerance is larger after a while; standards allow 2 km/h.
            tolerance = _SPEED_TOLERANCE if time < 0.6 * self.max_approach else _LATE_SPEED_TOLERANCE
            if abs(speed - self._approach_speed) > tolerance:
                self._steady_since = time
            if time - self._steady_since >= 1.0:
                if self.pedals is Pedals.COAST:
                    self._coasting = True
                    self._pedal_inputs = dict.fromkeys(self._pedal_inputs, 0.0)
                else:
                    self.steering_start = time
        self.gave_up = not self.is_steering and time > self.max_approach

    def ends(self, time: float, observation: Mapping[str, float]) -> bool:
        """Whether the run is over: the table has ended, the approach took too long, or the car has rolled over."""
        return (
            self.gave_up
            or time >= self.steering_start + self.time[-1]
            or abs(observation.get("chassis.roll", 0.0)) > ROLLED
        )


@dataclass(frozen=True, kw_only=True)
class CorneringSignals:
    """Signals of a run in a corner, shape (n,), positive to the left; NaN if the car has no such output."""

    result: Result
    """The whole run."""
    time: NDArray[np.float64]
    """s."""
    steering: NDArray[np.float64]
    """Steering-wheel angle, rad."""
    acceleration: NDArray[np.float64]
    """Lateral and horizontal, m/s²."""
    sideslip: NDArray[np.float64]
    """Sideslip angle, rad."""
    roll: NDArray[np.float64]
    """Roll angle, rad."""
    speed: NDArray[np.float64]
    """m/s."""


@dataclass(frozen=True, kw_only=True)
class SteeredRun(CorneringSignals):
    """Signals at equally spaced times, from at most 1 s before the steering, which starts at time 0.

    They are empty if the steering did not begin. The result has intervals of at least 5 ms.
    """

    steering_start: float
    """Start of the steering in the time of `result`, s; NaN if the car did not reach its speed."""
    yaw_rate: NDArray[np.float64]
    """rad/s."""
    whole: bool
    """Whether the table was driven to its end."""

    def shortfall(self, amplitude: float) -> str:
        """A sentence if the steering wheel did not reach a requested angle, rad; otherwise empty."""
        reached = float(np.abs(self.steering).max()) if len(self.steering) else math.nan
        if not reached < _MIN_FRACTION * amplitude:
            return ""
        return (
            f"The steering wheel came to {math.degrees(reached):.3g}° where {math.degrees(amplitude):.3g}° were asked "
            "for: the car's own steering is slower."
        )

    @property
    def interval(self) -> float:
        """Interval of the samples, s."""
        return float(self.time[1] - self.time[0])

    def thinned(self, interval: float = 0.02) -> Result:
        """The record since 1 s before the start of the steering, with rows at least an interval, s, apart."""
        result = self.result
        step = float(result.time[1] - result.time[0]) if len(result.time) > 1 else interval
        first = 0
        if math.isfinite(self.steering_start):
            first = int(np.searchsorted(result.time, self.steering_start - 1.0 - _ROUND_OFF))
        rows = np.arange(first, len(result.time), max(1, math.floor(interval / step + _ROUND_OFF)))
        return replace(result, time=result.time[rows], values=result.values[rows])


def steer(
    car: TestedCar,
    name: str,
    speed: float,
    time: NDArray[np.float64],
    angle: NDArray[np.float64],
    pedals: Pedals,
    lateral_limit: float = math.inf,
) -> SteeredRun:
    """Drive the car straight up to a speed, then steer it by a table.

    `speed`: m/s; `time`, `angle`: table, s from the start of the steering and rad, shape (n,); `lateral_limit`:
    lateral acceleration at which the run ends, m/s².
    """
    start = start_at_speed(car, speed + (_COAST_FROM if pedals is Pedals.COAST else 0.0))
    max_approach = 30.0 if start else 90.0
    pilot = SteeredPilot(car, speed, time, angle, pedals, max_approach)
    manoeuvre = Manoeuvre(
        name,
        np.zeros(1),
        dict.fromkeys([pilot.input.name, "throttle"], np.zeros(1)),
        max_approach + float(time[-1]) + 2.0 * car.facts.step,
        start,
    )

    def ends(t: float, observation: Mapping[str, float]) -> bool:
        return pilot.ends(t, observation) or abs(observation["chassis.ay"]) > lateral_limit

    result = car.drive(manoeuvre, pilot, ends, _INTERVAL)
    return _steered_run(result, pilot, car.facts.step)


def level_acceleration(result: Result) -> NDArray[np.float64]:
    """Horizontal lateral acceleration, m/s², shape (n,), from the accelerations along the body's y and z axes."""
    ay = result["chassis.ay"]
    if "chassis.roll" not in result or "chassis.az" not in result:
        return ay
    roll = result["chassis.roll"]
    return np.asarray(ay * np.cos(roll) - result["chassis.az"] * np.sin(roll))


def _steered_run(result: Result, pilot: SteeredPilot, step: float) -> SteeredRun:
    empty = np.zeros(0)
    if not pilot.is_steering or len(result.time) < 3 or result.time[-1] <= pilot.steering_start:
        signals = ("time", "steering", "yaw_rate", "acceleration", "sideslip", "roll", "speed")
        return SteeredRun(result=result, steering_start=math.nan, whole=False, **dict.fromkeys(signals, empty))
    row_interval = float(result.time[1] - result.time[0])
    interval = max(_INTERVAL, row_interval)
    # The grid has a sample at the start of the steering.
    first = pilot.steering_start - interval * math.floor(min(1.0, pilot.steering_start) / interval)
    selected = result.time > first - 1.5 * row_interval
    time, missing = result.time[selected], np.full(len(result.time), math.nan)
    grid = resample(time, time, interval, first)[0]

    def resampled(values: NDArray[np.float64]) -> NDArray[np.float64]:
        if not np.isfinite(values[selected]).all():
            return np.full(len(grid), math.nan)
        return resample(time, values[selected], interval, first)[1]

    names = ("chassis.wz", "sideslip", "chassis.roll", "speed")
    yaw_rate, sideslip, roll, speed = (resampled(result.continuous(n) if n in result else missing) for n in names)
    return SteeredRun(
        result=result,
        steering_start=pilot.steering_start,
        time=grid - pilot.steering_start,
        steering=resampled(pilot.input.measured_angle(result, step)),
        yaw_rate=yaw_rate,
        acceleration=resampled(level_acceleration(result)),
        sideslip=sideslip,
        roll=roll,
        speed=speed,
        whole=not result.failed_steps
        and bool(result.time[-1] >= pilot.steering_start + pilot.time[-1] - 1.5 * row_interval),
    )
