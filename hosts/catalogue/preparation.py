"""What runs of several tests share: communication step, constant inputs, run-up, conditions of an early end."""

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from hosts.catalogue.car import TestedCar
from hosts.common.numbers import Value
from hosts.driving.manoeuvre import INITIAL_SPEED, Manoeuvre
from hosts.driving.result import Result
from hosts.fmu.fmu import described

_MIN_RUN_UP = 1.0  # s
_MAX_RUN_UP = 120.0  # s, for a car that cannot be started at speed
SPUN = math.radians(90.0)
ROLLED = math.radians(60.0)


def with_step_up_to(car: TestedCar, longest: float, quantity: str) -> tuple[TestedCar, tuple[str, ...]]:
    """The car with a communication step that is short enough for a measured quantity.

    `car`: a requested step is not changed; `longest`: longest step, s; `quantity`: quantity of the note.

    Returns
    -------
    car : TestedCar
    notes : tuple of str
        A sentence if the step is longer and cannot be changed.
    """
    step = car.facts.step
    if step <= longest * (1.0 + 1e-9):
        return car, ()
    cosimulation = described(car.path).coSimulation
    can_vary = bool(getattr(cosimulation, "canHandleVariableCommunicationStepSize", False))
    if car.step is None and can_vary:
        return replace(car, step=longest), ()
    origin = "of the FMU, which takes no other" if car.step is None else "that was asked for"
    return car, (f"The step {origin} is {step:g} s; {quantity} needs {longest:g} s or less.",)


def constant_inputs(
    car: TestedCar, name: str, stop_time: float, inputs: Mapping[str, float], start: Mapping[str, Value]
) -> Manoeuvre:
    """A manoeuvre with constant inputs.

    `stop_time`: s; `inputs`: values by name, of which those that the car does not have are left out.
    """
    values = {n: np.full(2, x) for n, x in inputs.items() if n in car.facts.inputs}
    return Manoeuvre(name, np.array([0.0, stop_time]), values, stop_time, dict(start))


def start_at_speed(car: TestedCar, speed: float) -> dict[str, Value]:
    """Start values of a car that starts at a speed, m/s; empty if it cannot."""
    return {INITIAL_SPEED: speed} if INITIAL_SPEED in car.facts.parameters else {}


class RunUp:
    """The run-up on a straight line until a speed is held.

    `speed`: m/s. `start`: start values of the car; `longest`: longest time of the run-up, s.
    """

    def __init__(self, car: TestedCar, speed: float) -> None:
        self.start, self._speed = start_at_speed(car, speed), speed
        self.longest = _MIN_RUN_UP + 10.0 if self.start else _MAX_RUN_UP

    def is_over(self, time: float, observation: Mapping[str, float]) -> bool:
        """Whether the speed is held."""
        tolerance = max(0.005 * self._speed, 0.05)
        return time >= _MIN_RUN_UP - 1e-9 and abs(observation["speed"] - self._speed) <= tolerance


def early_end_notes(run: str, result: Result) -> tuple[str, ...]:
    """A sentence if the FMU refused a step; otherwise empty. `run`: name of the run."""
    return (f"{run}: {result.refusal}; what follows is not evaluated.",) if result.refusal else ()


class StopConditions:
    """Conditions of the end of a run, as a function of its outputs.

    `stands`: speed below which the car stands, m/s; 0: standing does not end the run. `reason`: ``stands``, ``spun`` or
    ``rolled`` by the last call; empty: the run continues.
    """

    def __init__(self, stands: float) -> None:
        self.stands = stands
        self.reason = ""

    def __call__(self, outputs: Mapping[str, float]) -> bool:
        """Whether the run is over; missing outputs are ignored."""
        self.reason = ""
        if abs(outputs.get("chassis.roll", 0.0)) > ROLLED:
            self.reason = "rolled"
        elif outputs["speed"] > 1.0 and abs(outputs.get("sideslip", 0.0)) > SPUN:
            self.reason = "spun"
        elif outputs["speed"] < self.stands:
            self.reason = "stands"
        return bool(self.reason)
