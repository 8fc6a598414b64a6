"""One run of the steady circle to one side: by constant radius, steering-wheel angle or speed."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from hosts.catalogue.car import TestedCar
from hosts.catalogue.preparation import start_at
from hosts.catalogue.steered_run import level_acceleration
from hosts.catalogue.steering import SteeringInput
from hosts.catalogue.stop_conditions import ROLLED
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.pilots.circle_follower import CircleFollower
from hosts.driving.pilots.combined_pilot import CombinedPilot
from hosts.driving.pilots.pilot import Pilot
from hosts.driving.pilots.speed_holder import SpeedHolder
from hosts.driving.result import Result

CONSTANT_RADIUS = 1.0
CONSTANT_ANGLE = 2.0
CONSTANT_SPEED = 3.0
_FIRST = 0.5  # m/s2 of lateral acceleration to begin with
_USUAL = 10.0  # m/s2, by which the progress is told
_FASTEST = 20.0  # m/s2 at which a run ends at the latest
_SETTLE = 3.0  # s at the first speed
_LAG = 1.5  # m/s that the speed may stay behind
_FALL = 1.0  # m/s2 below the largest lateral acceleration where a run ends
_SPUN = math.radians(45.0)
_RECORD = 0.02
_APPROACH = 60.0


@dataclass(frozen=True)
class CircleRun:
    """What a run yields, from where the car runs steadily to its largest lateral acceleration."""

    result: Result
    """All of the run, at longer intervals than it was driven."""
    time: NDArray[np.float64]
    acceleration: NDArray[np.float64]
    steering: NDArray[np.float64]
    sideslip: NDArray[np.float64]
    roll: NDArray[np.float64]
    torque: NDArray[np.float64]
    speed: NDArray[np.float64]
    """`time`, `acceleration`, `steering`, `sideslip`, `roll`, `torque`, `speed`: SI units, positive to the left; NaN
    where the car has no such output. The acceleration is level. Shape (n,) each."""
    largest: float
    """Lateral acceleration to the side of the run, mean over 1 s, m/s²."""
    end: str
    """What else than the grip of the tyres has ended the run, with "the" before; else empty."""
    steering_note: str
    """What is not known of the steering wheel; else empty."""


class _Watch:
    """Sees when the car runs steadily, from which time speed or steering rise, and when the run is over."""

    def __init__(self, side: float, method: float, first: float, rate: float, tolerance: float) -> None:
        self.side, self.method, self.first, self.rate, self.tolerance = side, method, first, rate, tolerance
        self.begin = math.nan
        self.end = ""
        self.off_circle: Callable[[Mapping[str, float]], float] = lambda observation: 0.0
        self._off_since = 0.0
        self._smooth = 0.0
        self._largest = 0.0
        self._time = 0.0

    def speed(self, time: float) -> float:
        """Wanted, m/s."""
        return self.first + (0.0 if self.method == CONSTANT_SPEED else self.risen(time))

    def risen(self, time: float) -> float:
        """Increase of the quantity that is raised during the run."""
        return self.rate * max(time - self.begin, 0.0) if math.isfinite(self.begin) else 0.0

    def ends(self, time: float, observation: Mapping[str, float]) -> bool:
        """Whether the run is over."""
        lag = self.speed(time) - observation["speed"]
        step, self._time = time - self._time, time
        if not math.isfinite(self.begin):
            if abs(lag) > 0.3:
                self._off_since = time
            if time - self._off_since >= _SETTLE:
                self.begin = time
            if time > _APPROACH:
                self.end = f"the car did not reach {3.6 * self.first:.3g} km/h within {_APPROACH:g} s."
            return time > _APPROACH
        if abs(observation.get("sideslip", 0.0)) > _SPUN or abs(observation.get("chassis.roll", 0.0)) > ROLLED:
            return True
        self._smooth += step / 0.5 * (self.side * observation["chassis.ay"] - self._smooth)
        self._largest = max(self._largest, self._smooth)
        if lag > _LAG:
            self.end = (
                f"the drive ended the run: at {3.6 * observation['speed']:.3g} km/h and {self._smooth:.3g} m/s² the "
                "speed does not rise further."
            )
            return True
        return abs(self.off_circle(observation)) > self.tolerance or self._smooth < self._largest - _FALL


def drive_circle(
    car: TestedCar, side: float, settings: Mapping[str, float], ratio: float, progress: Callable[[float], None]
) -> CircleRun:
    """Drive to one side until the car cannot go faster on the circle.

    `side`: 1 to the left, -1 to the right; `progress`: called with the part that is done.
    """
    method, radius = settings["method"], settings["radius"]
    steering = SteeringInput.of(car.facts)
    steady = method == CONSTANT_SPEED
    first = settings["speed"] / 3.6 if steady else math.sqrt(_FIRST * radius)
    rate = math.radians(settings["steering_rate"]) if steady else settings["speed_rise"]
    watch = _Watch(side, method, first, rate, settings["tolerance"])
    pilot = _pilot(car, side, method, radius, ratio, steering, watch)
    ramp_time = steering.largest / rate if steady else (math.sqrt(_FASTEST * radius) - first) / rate
    stop = _APPROACH + (min(ramp_time, 300.0) if math.isfinite(ramp_time) else 300.0)
    expected = 0.2 * ramp_time * rate if steady else math.sqrt(_USUAL * radius) - first
    name = f"circle to the {'left' if side > 0.0 else 'right'}"
    reported_time = 0.0

    def ends(time: float, observation: Mapping[str, float]) -> bool:
        nonlocal reported_time
        if time - reported_time > 1.0:
            reported_time = time
            progress(min(watch.risen(time) / expected, 1.0))
        return watch.ends(time, observation)

    result = car.drive(Manoeuvre(name, np.zeros(0), {}, stop, start_at(car, first)), pilot, ends, record_step=_RECORD)
    if result.refusal:
        watch.end = f"{result.refusal}."
    return _signals(result, watch, steering, car.facts.step)


def _pilot(
    car: TestedCar, side: float, method: float, radius: float, ratio: float, steering: SteeringInput, watch: _Watch
) -> Pilot:
    brakes = "brake" in car.facts.inputs
    wheelbase = car.facts.constants["vehicle.wheelbase"]
    if method == CONSTANT_RADIUS:
        full = steering.largest if math.isfinite(steering.largest) else 2.0 * math.pi
        limit = full * steering.per_radian
        follower = CircleFollower(
            side * radius, watch.speed, wheelbase, 1.0 / (ratio * steering.per_radian), steering.name, limit
        )
        watch.off_circle = follower.offset
        return follower
    if method == CONSTANT_ANGLE:
        angle = side * ratio * math.atan(wheelbase / radius)
        return CombinedPilot(SpeedHolder(watch.speed, brakes=brakes), _Wheel(steering, lambda time: angle))
    return CombinedPilot(
        SpeedHolder(watch.speed, brakes=brakes),
        _Wheel(steering, lambda time: side * min(watch.risen(time), steering.largest)),
    )


class _Wheel:
    """Turns the steering wheel to an angle that is a function of the time."""

    def __init__(self, steering: SteeringInput, angle: Callable[[float], float]) -> None:
        self.steering, self.angle = steering, angle

    def act(self, time: float, observation: Mapping[str, float]) -> dict[str, float]:
        return {self.steering.name: self.steering.per_radian * self.angle(time)}


def _signals(result: Result, watch: _Watch, steering: SteeringInput, step: float) -> CircleRun:
    steady = np.flatnonzero(result.time >= (watch.begin if math.isfinite(watch.begin) else math.inf))
    largest = math.nan
    if len(steady):
        width = min(max(1, round(1.0 / _interval(result.time))), len(steady))
        mean = sliding_window_view(watch.side * level_acceleration(result)[steady], width).mean(axis=1)
        largest = float(mean.max())
        steady = steady[: int(np.argmax(mean)) + width // 2 + 1]  # behind it the car slides off

    def of(name: str) -> NDArray[np.float64]:
        return result.continuous(name)[steady] if name in result else np.full(len(steady), math.nan)

    return CircleRun(
        result,
        result.time[steady],
        level_acceleration(result)[steady],
        steering.measured(result, step)[steady],
        of("sideslip"),
        of("chassis.roll"),
        of("steering_wheel_torque"),
        of("speed"),
        largest,
        watch.end,
        steering.note,
    )


def _interval(time: NDArray[np.float64]) -> float:
    return float(time[1] - time[0]) if len(time) > 1 else _RECORD
