"""Steering-wheel angle over steady lateral acceleration, from a slow ramp of the steering at constant speed."""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hosts.catalogue.car import TestedCar
from hosts.catalogue.measure_sheet import Sheet
from hosts.catalogue.steered_run import Pedals, SteeredRun, steer
from hosts.catalogue.steering import SteeringInput
from hosts.common.errors import HostError
from hosts.driving.result import Result
from hosts.measures.filters import phaseless_low_pass
from hosts.measures.log_plausibility import relations_plausibility
from hosts.measures.measure import Measure
from hosts.measures.signal import Signal

_SLOW_RATE = math.radians(2.0)
_FAST_RATE = math.radians(13.5)
_SLOW_UNTIL = math.radians(60.0)
_MAX_ANGLE = math.radians(540.0)
_INPUT_RATE = 0.005  # 1/s
_FIT_RANGE = (0.3, 1.2)  # m/s2
_MAX_LAG = 1.0  # s
MIN_SAMPLES = 20
MIN_ACCELERATION = 0.5  # m/s2


@dataclass(frozen=True)
class SteadyMap:
    """The map of one side."""

    speed: float
    """m/s."""
    angle: NDArray[np.float64]
    acceleration: NDArray[np.float64]
    """`angle`, `acceleration`, shape (n,): rad and m/s²; filtered, up to the largest acceleration."""
    run: SteeredRun
    notes: tuple[str, ...] = ()

    @property
    def largest(self) -> float:
        """Largest lateral acceleration, m/s²."""
        return float(self.acceleration.max()) if len(self.acceleration) else 0.0

    def angle_at(self, acceleration: float) -> float:
        """Angle at a lateral acceleration, m/s², in rad; NaN if it was not reached."""
        if self.largest < acceleration:
            return math.nan
        return float(np.interp(acceleration, np.maximum.accumulate(self.acceleration), self.angle))

    def required_angle_at(self, acceleration: float, setting: str = "lateral_acceleration") -> float:
        """Angle at the lateral acceleration of a setting, rad. Raises `HostError` if it was not reached."""
        angle = self.angle_at(acceleration)
        if math.isnan(angle):
            raise HostError(
                f"At {3.6 * self.speed:g} km/h the car reaches {self.largest:.3g} m/s² in a slow ramp of the steering, "
                f"not the {acceleration:g} m/s² of {setting}; choose less."
            )
        return angle


def steady_map(car: TestedCar, speed: float, acceleration: float) -> SteadyMap:
    """Drive a ramp to the left; the map is empty if the car does not reach the speed.

    `speed`: m/s; `acceleration`: upper end of the map, m/s².

    Notes
    -----
    The steering wheel turns by 2 °/s up to 60°, then by 13.5 °/s. The car lags by some tenths of a second, so that the
    angles are too large. The error is the intercept of a regression line through the first part of the ramp, 0.3 to 1.2
    m/s², and is subtracted.
    """
    steering = SteeringInput.of(car.facts)
    if steering.is_angle:
        largest = min(_MAX_ANGLE, steering.largest)
        slow_angle = min(_SLOW_UNTIL, largest)
        time = np.array([0.0, slow_angle / _SLOW_RATE, slow_angle / _SLOW_RATE + (largest - slow_angle) / _FAST_RATE])
        angle = np.array([0.0, slow_angle, largest])
    else:
        time, angle = np.array([0.0, steering.largest / _INPUT_RATE]), np.array([0.0, steering.largest])
    run = steer(car, "ramp left", speed, time, angle, Pedals.HOLD_SPEED, 1.1 * acceleration)
    if len(run.time) < 20:
        return SteadyMap(speed, np.zeros(0), np.zeros(0), run)
    # One filter for both, so that they have no relative delay.
    frequency = min(6.0, 0.2 / run.interval)
    turned, lateral = (phaseless_low_pass(x, run.interval, frequency) for x in (run.steering, run.acceleration))
    before = run.time < 0.0
    if before.any():
        turned, lateral = turned - turned[before].mean(), lateral - lateral[before].mean()
    after_start = run.time >= 0.0
    turned, lateral = turned[after_start], lateral[after_start]
    turned = turned - _lag_angle(turned, lateral, float(angle[1] / time[1]))
    top = int(np.argmax(lateral)) + 1
    return SteadyMap(speed, turned[:top], lateral[:top], run)


def _lag_angle(angle: NDArray[np.float64], acceleration: NDArray[np.float64], rate: float) -> NDArray[np.float64]:
    """Angles by which a ramp leads the response, rad, shape (n,). `rate`: rate of the ramp, rad/s."""
    fitted = (
        (acceleration >= _FIT_RANGE[0])
        & (acceleration <= _FIT_RANGE[1])
        & (np.arange(len(angle)) < np.argmax(acceleration))
    )
    if fitted.sum() < 5:
        return np.zeros(len(angle))
    slope, offset = np.polyfit(angle[fitted], acceleration[fitted], 1)
    lag = min(max(-offset / slope, 0.0), rate * _MAX_LAG) if slope > 0.0 else 0.0
    return np.asarray(np.minimum(lag, angle))


def map_at_reachable_speed(car: TestedCar, speed: float, lower: float, acceleration: float) -> SteadyMap:
    """The map at a speed or, for a car that does not reach it, at a lower one.

    `speed`, `lower`: m/s; `acceleration`: upper end of the map, m/s². Raises `HostError` if the car reaches neither
    speed, its FMU refuses a step, or signs or units of its signals are implausible.
    """
    result = steady_map(car, speed, acceleration)
    if not len(result.angle) and lower < speed:
        note = f"The car does not hold {3.6 * speed:g} km/h; the test is done at {3.6 * lower:g} km/h."
        result = replace(steady_map(car, lower, acceleration), notes=(note,))
    if not len(result.angle):
        raise HostError(why_not_reached(result.run.result, result.speed))
    refuse_implausible(result.run)
    return result


def drive_ramp(sheet: Sheet, acceleration: float) -> SteadyMap:
    """Drive a ramp at the setting `speed`, or at 80 km/h for a slower car, and add its results to the sheet."""
    speed = sheet.settings["speed"] / 3.6
    ramp = map_at_reachable_speed(sheet.car, speed, min(speed, 80.0 / 3.6), acceleration)
    sheet.runs["ramp_left"] = ramp.run.thinned()
    sheet.measures.append(Measure("speed", ramp.speed, "m/s", f"speed {sheet.setting_text('speed')}"))
    sheet.notes += [*ramp.notes, *filter(None, [SteeringInput.of(sheet.car.facts).note])]
    return ramp


def refuse_implausible(run: SteeredRun) -> None:
    """Raise `HostError` if steering, speed, yaw rate and lateral acceleration of a slow turn are not consistent.

    The message names a sign or unit of the alias file that would explain it.
    """
    if len(run.time) < MIN_SAMPLES or not np.abs(run.acceleration).max() >= MIN_ACCELERATION:
        return
    columns = (
        ("steering_wheel_angle", "rad", run.steering),
        ("speed", "m/s", run.speed),
        ("chassis.wz", "rad/s", run.yaw_rate),
        ("chassis.ay", "m/s2", run.acceleration),
    )
    signals = {n: Signal(n, n, unit, run.time, x) for n, unit, x in columns if np.all(np.isfinite(x))}
    for sentence in relations_plausibility("In a slow turn", signals).warnings():
        raise HostError(f"{sentence} An alias file gives signs and units by factor.")


def why_not_reached(result: Result, speed: float) -> str:
    """A sentence on why a run did not reach its speed, m/s."""
    end = float(result.time[-1])
    if result.refusal:
        return f"Before the steering began {result.refusal}."
    speeds = 3.6 * result["speed"]
    return (
        f"The car does not hold {3.6 * speed:g} km/h on a straight line: after {end:.3g} s it is "
        f"at {speeds[-1]:.3g} km/h, its fastest was {speeds.max():.3g}. Choose a lower speed (--test-setting "
        "TEST.speed=...)."
    )
