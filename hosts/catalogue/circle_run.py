"""One run of the steady circle to one side: by constant radius, steering-wheel angle or speed."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from hosts.catalogue.car import TestedCar
from hosts.catalogue.preparation import ROLLED, start_at_speed
from hosts.catalogue.steered_run import CorneringSignals, level_acceleration
from hosts.catalogue.steering import SteeringInput
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.pilots.circle_follower import CircleFollower
from hosts.driving.pilots.combined_pilot import CombinedPilot
from hosts.driving.pilots.pilot import Pilot
from hosts.driving.pilots.speed_holder import SpeedHolder
from hosts.driving.result import Result

CONSTANT_RADIUS = 1.0
CONSTANT_ANGLE = 2.0
CONSTANT_SPEED = 3.0
_FIRST_ACCELERATION = 0.5  # m/s2, at the first speed
_EXPECTED_ACCELERATION = 10.0  # m/s2, of complete progress
_MAX_ACCELERATION = 20.0  # m/s2, of the longest run
_SETTLE = 3.0  # s at the first speed
_LAG = 1.5  # m/s, of the speed behind its target at which a run ends
_DECREASE = 1.0  # m/s2, of the lateral acceleration below its largest value at which a run ends
_SPUN = math.radians(45.0)
_RECORD_STEP = 0.02  # s
_APPROACH_TIME = 60.0  # s, until the first speed is reached


@dataclass(frozen=True, kw_only=True)
class CircleRun(CorneringSignals):
    """Signals from steady driving at the first speed to the largest lateral acceleration, at intervals of 20 ms."""

    torque: NDArray[np.float64]
    """Steering-wheel torque, N m."""
    largest: float
    """Largest lateral acceleration to the side of the run, mean over 1 s, m/s²."""
    end: str
    """Cause of the end of the run other than the grip of the tyres, as a clause; otherwise empty."""
    steering_note: str
    """A sentence on unknown angles of the steering wheel; otherwise empty."""


class _RunMonitor:
    """Determines the start of the increase of speed or steering, after steady driving, and the end of the run."""

    def __init__(self, side: float, method: float, first: float, rate: float, tolerance: float) -> None:
        self.side, self.method, self.first, self.rate, self.tolerance = side, method, first, rate, tolerance
        self.begin = math.nan
        self.end = ""
        self.off_circle: Callable[[Mapping[str, float]], float] = lambda observation: 0.0
        self._last_off_speed = 0.0
        self._smoothed = 0.0
        self._largest = 0.0
        self._time = 0.0

    def speed(self, time: float) -> float:
        """Target speed, m/s."""
        return self.first + (0.0 if self.method == CONSTANT_SPEED else self.increase(time))

    def increase(self, time: float) -> float:
        """Increase of the quantity that is raised during the run."""
        return self.rate * max(time - self.begin, 0.0) if math.isfinite(self.begin) else 0.0

    def ends(self, time: float, observation: Mapping[str, float]) -> bool:
        """Whether the run is over."""
        lag = self.speed(time) - observation["speed"]
        step, self._time = time - self._time, time
        if not math.isfinite(self.begin):
            if abs(lag) > 0.3:
                self._last_off_speed = time
            if time - self._last_off_speed >= _SETTLE:
                self.begin = time
            if time > _APPROACH_TIME:
                self.end = f"the car did not reach {3.6 * self.first:.3g} km/h within {_APPROACH_TIME:g} s."
            return time > _APPROACH_TIME
        if abs(observation.get("sideslip", 0.0)) > _SPUN or abs(observation.get("chassis.roll", 0.0)) > ROLLED:
            return True
        self._smoothed += step / 0.5 * (self.side * observation["chassis.ay"] - self._smoothed)
        self._largest = max(self._largest, self._smoothed)
        if lag > _LAG:
            self.end = (
                f"the drive ended the run: at {3.6 * observation['speed']:.3g} km/h and {self._smoothed:.3g} m/s² the "
                "speed does not rise further."
            )
            return True
        return abs(self.off_circle(observation)) > self.tolerance or self._smoothed < self._largest - _DECREASE


def drive_circle(
    car: TestedCar, side: float, settings: Mapping[str, float], ratio: float, progress: Callable[[float], None]
) -> CircleRun:
    """Drive a circle to one side up to the largest lateral acceleration.

    `side`: 1: left, -1: right; `settings`: settings of the test; `ratio`: steering ratio; `progress`: called with the
    fraction that is done, 0 to 1.
    """
    method, radius = settings["method"], settings["radius"]
    steering = SteeringInput.of(car.facts)
    by_steering = method == CONSTANT_SPEED
    first_speed = settings["speed"] / 3.6 if by_steering else math.sqrt(_FIRST_ACCELERATION * radius)
    rate = math.radians(settings["steering_rate"]) if by_steering else settings["speed_rise"]
    monitor = _RunMonitor(side, method, first_speed, rate, settings["tolerance"])
    pilot = _pilot(car, side, method, radius, ratio, steering, monitor)
    ramp_time = steering.largest / rate if by_steering else (math.sqrt(_MAX_ACCELERATION * radius) - first_speed) / rate
    stop = _APPROACH_TIME + (min(ramp_time, 300.0) if math.isfinite(ramp_time) else 300.0)
    expected = 0.2 * ramp_time * rate if by_steering else math.sqrt(_EXPECTED_ACCELERATION * radius) - first_speed
    name = f"circle to the {'left' if side > 0.0 else 'right'}"
    reported_time = 0.0

    def ends(time: float, observation: Mapping[str, float]) -> bool:
        nonlocal reported_time
        if time - reported_time > 1.0:
            reported_time = time
            progress(min(monitor.increase(time) / expected, 1.0))
        return monitor.ends(time, observation)

    result = car.drive(
        Manoeuvre(name, np.zeros(0), {}, stop, start_at_speed(car, first_speed)), pilot, ends, record_step=_RECORD_STEP
    )
    if result.refusal:
        monitor.end = f"{result.refusal}."
    return _circle_run(result, monitor, steering, car.facts.step)


def _pilot(
    car: TestedCar,
    side: float,
    method: float,
    radius: float,
    ratio: float,
    steering: SteeringInput,
    monitor: _RunMonitor,
) -> Pilot:
    brakes = "brake" in car.facts.inputs
    wheelbase = car.facts.constants["vehicle.wheelbase"]
    if method == CONSTANT_RADIUS:
        full_lock = steering.largest if math.isfinite(steering.largest) else 2.0 * math.pi
        limit = full_lock * steering.per_radian
        follower = CircleFollower(
            side * radius, monitor.speed, wheelbase, 1.0 / (ratio * steering.per_radian), steering.name, limit
        )
        monitor.off_circle = follower.offset
        return follower
    if method == CONSTANT_ANGLE:
        angle = side * ratio * math.atan(wheelbase / radius)
        return CombinedPilot(SpeedHolder(monitor.speed, brakes=brakes), _SteeringOverTime(steering, lambda time: angle))
    return CombinedPilot(
        SpeedHolder(monitor.speed, brakes=brakes),
        _SteeringOverTime(steering, lambda time: side * min(monitor.increase(time), steering.largest)),
    )


class _SteeringOverTime:
    """A pilot that steers by an angle of the steering wheel over time, rad."""

    def __init__(self, steering: SteeringInput, angle: Callable[[float], float]) -> None:
        self.steering, self.angle = steering, angle

    def act(self, time: float, observation: Mapping[str, float]) -> dict[str, float]:
        return {self.steering.name: self.steering.per_radian * self.angle(time)}


def _circle_run(result: Result, monitor: _RunMonitor, steering: SteeringInput, step: float) -> CircleRun:
    steady = np.flatnonzero(result.time >= (monitor.begin if math.isfinite(monitor.begin) else math.inf))
    largest = math.nan
    if len(steady):
        width = min(max(1, round(1.0 / _interval(result.time))), len(steady))
        means = sliding_window_view(monitor.side * level_acceleration(result)[steady], width).mean(axis=1)
        largest = float(means.max())
        steady = steady[: int(np.argmax(means)) + width // 2 + 1]  # later the car slides

    def signal(name: str) -> NDArray[np.float64]:
        return result.continuous(name)[steady] if name in result else np.full(len(steady), math.nan)

    return CircleRun(
        result=result,
        time=result.time[steady],
        acceleration=level_acceleration(result)[steady],
        steering=steering.measured_angle(result, step)[steady],
        sideslip=signal("sideslip"),
        roll=signal("chassis.roll"),
        torque=signal("steering_wheel_torque"),
        speed=signal("speed"),
        largest=largest,
        end=monitor.end,
        steering_note=steering.note,
    )


def _interval(time: NDArray[np.float64]) -> float:
    return float(time[1] - time[0]) if len(time) > 1 else _RECORD_STEP
