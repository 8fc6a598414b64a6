"""Preparation that tests share: a fine enough step, held inputs, a message on a run that ended early."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from hosts.catalogue.car import TestedCar
from hosts.common.numbers import Value
from hosts.driving.manoeuvre import INITIAL_SPEED, Manoeuvre
from hosts.driving.result import Result
from hosts.fmu.fmu import described

_SETTLED = 1.0  # s, of driving straight at least
_LONGEST = 120.0  # s, of a car that cannot be started at speed


def with_step_up_to(car: TestedCar, longest: float, why: str) -> tuple[TestedCar, tuple[str, ...]]:
    """The car with a communication step that resolves what is measured.

    `car`: a step that was asked for is kept; `longest`: in s; `why`: what a longer step would not show, for the note.

    Returns
    -------
    car : TestedCar
    notes : tuple of str
        A sentence where the step is longer and cannot be changed.
    """
    step = car.facts.step
    if step <= longest * (1.0 + 1e-9):
        return car, ()
    cosimulation = described(car.path).coSimulation
    can_vary = bool(getattr(cosimulation, "canHandleVariableCommunicationStepSize", False))
    if car.step is None and can_vary:
        return replace(car, step=longest), ()
    whose = "of the FMU, which takes no other" if car.step is None else "that was asked for"
    return car, (f"The step {whose} is {step:g} s; {why} needs {longest:g} s or less.",)


def held(
    car: TestedCar, name: str, stop_time: float, inputs: Mapping[str, float], start: Mapping[str, Value]
) -> Manoeuvre:
    """A manoeuvre with inputs that do not change.

    `stop_time`: in s; `inputs`: those that the car does not have are left out.
    """
    values = {n: np.full(2, x) for n, x in inputs.items() if n in car.facts.inputs}
    return Manoeuvre(name, np.array([0.0, stop_time]), values, stop_time, dict(start))


def start_at(car: TestedCar, speed: float) -> dict[str, Value]:
    """Start values of a car that moves at a speed, m/s, from the first; none where it cannot be started so."""
    return {INITIAL_SPEED: speed} if INITIAL_SPEED in car.facts.parameters else {}


class RunUp:
    """Driving straight until a speed is held.

    `speed`: in m/s. `start`: start values of the car; `longest`: what it may take, s.
    """

    def __init__(self, car: TestedCar, speed: float) -> None:
        self.start, self._speed = start_at(car, speed), speed
        self.longest = _SETTLED + 10.0 if self.start else _LONGEST

    def is_over(self, time: float, observation: Mapping[str, float]) -> bool:
        """Whether the speed is held."""
        return time >= _SETTLED - 1e-9 and abs(observation["speed"] - self._speed) <= max(0.005 * self._speed, 0.05)


def early_end(run: str, result: Result) -> tuple[str, ...]:
    """A sentence where the FMU refused a step."""
    return (f"{run}: {result.refusal}; what follows is not evaluated.",) if result.refusal else ()
