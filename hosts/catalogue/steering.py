"""The input of the steering-wheel angle of a car, and the angle computed back from its signals."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hosts.catalogue.car import CarFacts
from hosts.common.errors import HostError
from hosts.driving.result import Result

ANGLE = "steering_wheel_angle"
DEMAND = "steering_wheel_angle_demand"
LARGEST = "vehicle.steering_wheel_angle_max"
NEED = f"{DEMAND} | {ANGLE} | steering"
"""What a car needs to be steered: one of these inputs."""


@dataclass(frozen=True)
class SteeringInput:
    """The input by which a car is steered."""

    name: str
    """By our names."""
    per_radian: float
    """Of the input, per radian of the steering wheel."""
    largest: float
    """Angle of the steering wheel at full lock, rad; infinite where the car does not provide it."""
    is_angle: bool = True
    """Whether angles are angles; else they are in units of the input, and `note` says so."""
    note: str = ""
    """Empty where all is known."""

    @classmethod
    def of(cls, facts: CarFacts) -> SteeringInput:
        """The best of the inputs of a car. Raises `HostError` if the car has no input to steer it."""
        full = abs(facts.constants.get(LARGEST, math.nan))
        limit = full if full > 0.0 else math.inf
        for name in (DEMAND, ANGLE):
            if name in facts.inputs:
                return cls(name, 1.0, limit)
        if "steering" not in facts.inputs:
            raise HostError(
                f"The car cannot be steered: it has none of the inputs {NEED.replace(' | ', ', ')}; an alias file says "
                "which of its inputs is one of them (--aliases)."
            )
        if full > 0.0:
            return cls("steering", 1.0 / full, full)
        note = (
            f"The car has no constant {LARGEST}: angles of the steering wheel are in units of the input 'steering', "
            "-1 to 1. [constants] of an alias file can give it."
        )
        return cls("steering", 1.0, 1.0, False, note)

    def measured(self, result: Result, step: float) -> NDArray[np.float64]:
        """Angle of the steering wheel over a run: that of the car if it reports it, else the demand.

        `result`: with n rows; `step`: communication step of the run, s. Returns an array of shape (n,), rad.
        """
        if self.is_angle and ANGLE in result:
            return result[ANGLE]
        values = result[self.name] / self.per_radian
        if len(values) < 2:
            return values
        # a row has the input of the step that begins there, which stands for the middle of the step
        back = 0.5 * step / float(result.time[1] - result.time[0])
        return np.asarray(np.append(values[:1], values[1:] - back * np.diff(values)))

    def why_no_angles(self, test: str) -> str | None:
        """Why a test that demands angles of the steering wheel cannot be done; None if it can."""
        if self.is_angle:
            return None
        return (
            f"The test {test} demands angles of the steering wheel in degrees, but the car takes only 'steering' from "
            f"-1 to 1; give {LARGEST} in rad in the table [constants] of an alias file (--aliases)."
        )
