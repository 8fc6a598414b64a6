"""The steering input of a car, the steering-wheel angle of its runs, and its steering ratio."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from hosts.catalogue.car import CarFacts, TestedCar
from hosts.catalogue.preparation import start_at_speed
from hosts.common.errors import HostError
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.pilots.combined_pilot import CombinedPilot
from hosts.driving.pilots.speed_holder import SpeedHolder
from hosts.driving.pilots.steering_table import SteeringTable
from hosts.driving.result import Result

ANGLE = "steering_wheel_angle"
DEMAND = "steering_wheel_angle_demand"
FULL_LOCK = "vehicle.steering_wheel_angle_max"
INPUTS = f"{DEMAND} | {ANGLE} | steering"
"""Inputs by which a car can be steered."""
RATIO = "vehicle.steering_ratio"
WHEELS = ("wheel_FL.steer", "wheel_FR.steer")
_SPEED = 3.0
_ANGLE = math.radians(30.0)


@dataclass(frozen=True)
class SteeringInput:
    """The input by which a car is steered."""

    name: str
    """Our name of the input."""
    per_radian: float
    """Value of the input per radian of the steering wheel."""
    largest: float
    """Angle of the steering wheel at full lock, rad; infinite if unknown."""
    is_angle: bool = True
    """Whether angles are in rad; otherwise they are in units of the input."""
    note: str = ""
    """A sentence if angles are unknown; otherwise empty."""

    @classmethod
    def of(cls, facts: CarFacts) -> SteeringInput:
        """The first of `INPUTS` that a car has. Raises `HostError` if it has none."""
        full_lock = abs(facts.constants.get(FULL_LOCK, math.nan))
        limit = full_lock if full_lock > 0.0 else math.inf
        for name in (DEMAND, ANGLE):
            if name in facts.inputs:
                return cls(name, 1.0, limit)
        if "steering" not in facts.inputs:
            raise HostError(
                f"The car cannot be steered: it has none of the inputs {INPUTS.replace(' | ', ', ')}; an alias file "
                "says which of its inputs is one of them (--aliases)."
            )
        if full_lock > 0.0:
            return cls("steering", 1.0 / full_lock, full_lock)
        note = (
            f"The car has no constant {FULL_LOCK}: angles of the steering wheel are in units of the input 'steering', "
            "-1 to 1. [constants] of an alias file can give it."
        )
        return cls("steering", 1.0, 1.0, False, note)

    def measured_angle(self, result: Result, step: float) -> NDArray[np.float64]:
        """Steering-wheel angle of a run, rad, shape (n,): the output of the car if it has one, otherwise the demand.

        `step`: communication step of the run, s.
        """
        if self.is_angle and ANGLE in result:
            return result[ANGLE]
        values = result[self.name] / self.per_radian
        if len(values) < 2:
            return values
        # The input of a row is that of the following step, which is the value at the middle of the step.
        offset = 0.5 * step / float(result.time[1] - result.time[0])
        return np.asarray(np.append(values[:1], values[1:] - offset * np.diff(values)))

    def why_no_angles(self, test: str) -> str | None:
        """A sentence if a test cannot be done because it needs angles of the steering wheel; otherwise None."""
        if self.is_angle:
            return None
        return (
            f"The test {test} demands angles of the steering wheel in degrees, but the car takes only 'steering' from "
            f"-1 to 1; give {FULL_LOCK} in rad in the table [constants] of an alias file (--aliases)."
        )


def steering_ratio(car: TestedCar) -> float:
    """Ratio of the angle of the steering wheel and the mean angle of the front wheels; NaN if unknown.

    If the car reports the angles of its wheels, by a regression while the steering wheel turns to 30° to both sides at
    3 m/s; otherwise the constant of the car.
    """
    if any(name not in car.facts.outputs for name in WHEELS):
        return car.facts.constants.get(RATIO, math.nan)
    steering = SteeringInput.of(car.facts)
    if not steering.is_angle:
        return car.facts.constants.get(RATIO, math.nan)
    times = np.array([0.0, 1.0, 3.0, 7.0])
    table = steering.per_radian * _ANGLE * np.array([0.0, 0.0, 1.0, -1.0])
    pilot = CombinedPilot(
        SpeedHolder(_SPEED, brakes="brake" in car.facts.inputs), SteeringTable(times, table, steering.name)
    )
    result = car.drive(
        Manoeuvre("steering ratio", np.zeros(0), {}, 7.0, start_at_speed(car, _SPEED)), pilot, record_step=0.02
    )
    wheels = 0.5 * (result[WHEELS[0]] + result[WHEELS[1]])
    rows = result.time > 1.0
    if rows.sum() < 10 or not np.ptp(wheels[rows]) > 1e-3:
        return car.facts.constants.get(RATIO, math.nan)
    return 1.0 / float(stats.linregress(steering.measured_angle(result, car.facts.step)[rows], wheels[rows]).slope)
