"""Steering wheel angle over steady lateral acceleration, from a slow ramp of the steering at constant speed."""

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

_SLOW = math.radians(2.0)
_FAST = math.radians(13.5)
_SLOW_UNTIL = math.radians(60.0)
_LARGEST = math.radians(540.0)
_RATE_OF_INPUT = 0.005
_LINE = (0.3, 1.2)
_LATEST = 1.0
FEWEST = 20  # smallest number of samples
ENOUGH = 0.5  # smallest range, m/s2


@dataclass(frozen=True)
class SteadyMap:
    """The map of one side."""

    speed: float
    """m/s."""
    angle: NDArray[np.float64]
    acceleration: NDArray[np.float64]
    """`angle`, `acceleration`, shape (n,): sizes, rad and m/s²; filtered, up to the largest acceleration."""
    run: SteeredRun
    notes: tuple[str, ...] = ()

    @property
    def largest(self) -> float:
        """Lateral acceleration that was reached, m/s²."""
        return float(self.acceleration.max()) if len(self.acceleration) else 0.0

    def angle_at(self, acceleration: float) -> float:
        """Angle for a lateral acceleration, rad; NaN if it was not reached."""
        if self.largest < acceleration:
            return math.nan
        return float(np.interp(acceleration, np.maximum.accumulate(self.acceleration), self.angle))

    def need_angle_at(self, acceleration: float, setting: str = "lateral_acceleration") -> float:
        """The same of a setting. Raises `HostError` if it was not reached."""
        angle = self.angle_at(acceleration)
        if math.isnan(angle):
            raise HostError(
                f"At {3.6 * self.speed:g} km/h the car reaches {self.largest:.3g} m/s² in a slow ramp of the steering, "
                f"not the {acceleration:g} m/s² of {setting}; choose less."
            )
        return angle


def steady_map(car: TestedCar, speed: float, acceleration: float) -> SteadyMap:
    """Drive the ramp to the left; the map is empty if the car does not come to the speed.

    `speed`: in m/s; `acceleration`: up to which the map is wanted, m/s².

    Notes
    -----
    The steering wheel turns by 2 °/s up to 60°, then by 13.5 °/s. The car is late by some tenths of a second, so the
    angles are too large by what it turns in this time. That angle is where a straight line through the first part of
    the ramp, 0.3 to 1.2 m/s², meets zero; it is taken off as long as the wheel turns slowly.
    """
    steering = SteeringInput.of(car.facts)
    if steering.is_angle:
        largest = min(_LARGEST, steering.largest)
        slow = min(_SLOW_UNTIL, largest)
        time = np.array([0.0, slow / _SLOW, slow / _SLOW + (largest - slow) / _FAST])
        angle = np.array([0.0, slow, largest])
    else:
        time, angle = np.array([0.0, steering.largest / _RATE_OF_INPUT]), np.array([0.0, steering.largest])
    run = steer(car, "ramp left", speed, time, angle, Pedals.HOLD_SPEED, 1.1 * acceleration)
    if len(run.time) < 20:
        return SteadyMap(speed, np.zeros(0), np.zeros(0), run)
    # one filter for both, so that neither is late against the other
    frequency = min(6.0, 0.2 / run.interval)
    turned, lateral = (phaseless_low_pass(x, run.interval, frequency) for x in (run.steering, run.acceleration))
    zero = run.time < 0.0
    if zero.any():
        turned, lateral = turned - turned[zero].mean(), lateral - lateral[zero].mean()
    after_start = run.time >= 0.0
    turned, lateral = turned[after_start], lateral[after_start]
    turned = turned - _late(turned, lateral, float(angle[1] / time[1]))
    top = int(np.argmax(lateral)) + 1
    return SteadyMap(speed, turned[:top], lateral[:top], run)


def _late(angle: NDArray[np.float64], acceleration: NDArray[np.float64], rate: float) -> NDArray[np.float64]:
    """By how much angles of a ramp run ahead of the answer, rad, up to each."""
    first = (acceleration >= _LINE[0]) & (acceleration <= _LINE[1]) & (np.arange(len(angle)) < np.argmax(acceleration))
    if first.sum() < 5:
        return np.zeros(len(angle))
    slope, offset = np.polyfit(angle[first], acceleration[first], 1)
    late = min(max(-offset / slope, 0.0), rate * _LATEST) if slope > 0.0 else 0.0
    return np.asarray(np.minimum(late, angle))


def map_at_reachable_speed(car: TestedCar, speed: float, lower: float, acceleration: float) -> SteadyMap:
    """The map at a speed or, for a car that does not reach it, at a lower one.

    `speed`, `lower`: in m/s; `acceleration`: up to which the map is wanted, m/s². Raises `HostError` if the car reaches
    neither, its FMU refuses a step, or signs or units of its signals do not fit.
    """
    result = steady_map(car, speed, acceleration)
    if not len(result.angle) and lower < speed:
        note = f"The car does not hold {3.6 * speed:g} km/h; the test is done at {3.6 * lower:g} km/h."
        result = replace(steady_map(car, lower, acceleration), notes=(note,))
    if not len(result.angle):
        raise HostError(why_not_reached(result.run.result, result.speed))
    refuse_odd(result.run)
    return result


def driven_ramp(sheet: Sheet, acceleration: float) -> SteadyMap:
    """`map_at_reachable_speed` of the setting `speed` or of 80 km/h; speed, run and notes are on the sheet."""
    speed = sheet.settings["speed"] / 3.6
    ramp = map_at_reachable_speed(sheet.car, speed, min(speed, 80.0 / 3.6), acceleration)
    sheet.runs["ramp_left"] = ramp.run.thinned()
    sheet.measures.append(Measure("speed", ramp.speed, "m/s", f"speed {sheet.words_of('speed')}"))
    sheet.notes += [*ramp.notes, *filter(None, [SteeringInput.of(sheet.car.facts).note])]
    return ramp


def refuse_odd(run: SteeredRun) -> None:
    """Refuse a slow turn whose steering, speed, yaw rate and lateral acceleration do not belong together.

    Raises `HostError` with what would explain it, as a sign or unit of an alias file.
    """
    if len(run.time) < FEWEST or not np.abs(run.acceleration).max() >= ENOUGH:
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
    """Why the steering did not begin at a speed, m/s, in a run: a sentence."""
    end = float(result.time[-1])
    if result.refusal:
        return f"Before the steering began {result.refusal}."
    speeds = 3.6 * result["speed"]
    return (
        f"The car does not hold {3.6 * speed:g} km/h on a straight line: after {end:.3g} s it is "
        f"at {speeds[-1]:.3g} km/h, its fastest was {speeds.max():.3g}. Choose a lower speed (--test-setting "
        "TEST.speed=...)."
    )
