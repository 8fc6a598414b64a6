"""Driving without a page: inputs are constant, or those of a manoeuvre or a random driver."""

import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Protocol

from ali3.bars import bar
from hosts.common.errors import HostError
from hosts.driving.driver import check_drivable, make_driver
from hosts.driving.manoeuvre import Manoeuvre, with_names_of
from hosts.driving.pilots.course_follower import CourseFollower
from hosts.driving.pilots.pilot import OBSERVED
from hosts.driving.random_driver import RandomDriver
from hosts.simulator.aliased_car import AliasedCar
from hosts.simulator.preparation import DriveRequest

_PERIOD = 0.005  # s between two looks at the state of the car
_BAR = "{n:.1f} of {total:.1f} s simulated |{bar}| {elapsed}<{remaining}"
_PATIENCE = 10.0  # s without a step, after which the run is aborted


class HeadlessDriver(Protocol):
    """The source of the inputs when no page drives."""

    def act(self, time: float, observation: Mapping[str, float]) -> Mapping[str, float]:
        """Values of inputs at a time, s."""


class ConstantInputs:
    """A driver that leaves all inputs at their start values."""

    def act(self, time: float, observation: Mapping[str, float]) -> Mapping[str, float]:
        return {}


class ManoeuvreDriver:
    """A driver with the inputs of a manoeuvre: of its table and of its driver, if it has one.

    Raises `HostError` if the car lacks a variable, or the manoeuvre needs a previous run.
    """

    def __init__(self, manoeuvre: Manoeuvre, car: AliasedCar) -> None:
        if (unknown := next((name for name in manoeuvre.inputs if name not in car.inputs), None)) is not None:
            raise HostError(
                f"The manoeuvre '{manoeuvre.name}' has a column '{unknown}', which is not an input of this FMU; the "
                f"simulator moves inputs only: {', '.join(car.inputs) or 'none'}."
            )
        if manoeuvre.find_throttle:
            raise HostError(
                f"The manoeuvre '{manoeuvre.name}' finds its throttle in a run before, which the simulator does not "
                "make; give the table that 'ali3 run' writes of it."
            )
        self._manoeuvre = manoeuvre
        self._driver: CourseFollower | None = None
        if manoeuvre.driver:
            check_drivable(car.inputs, car.names, "this FMU")
            self._driver = make_driver(manoeuvre.driver, car.constants)

    def act(self, time: float, observation: Mapping[str, float]) -> Mapping[str, float]:
        result = self._manoeuvre.at(time)
        return result if self._driver is None else {**result, **self._driver.act(time, observation)}


def with_start_of(request: DriveRequest, manoeuvre: Manoeuvre) -> DriveRequest:
    """A request with the start values of a manoeuvre."""
    return replace(request, manoeuvre=manoeuvre.name, start=lambda names: with_names_of(manoeuvre, names).start)


def headless_driver(car: AliasedCar, manoeuvre: Manoeuvre | None, seed: int | None) -> HeadlessDriver:
    """The driver of a car. `seed`: seed of a random driver, without a manoeuvre."""
    if manoeuvre is not None:
        return ManoeuvreDriver(manoeuvre, car)
    return ConstantInputs() if seed is None else RandomDriver(seed, car.inputs)


def run_headless(car: AliasedCar, driver: HeadlessDriver, seconds: float, tell: Callable[[str, str], None]) -> bool:
    """Drive for a simulated time; False if a step was refused.

    Parameters
    ----------
    car : AliasedCar
        Paused.
    seconds : float
        Simulated time, s.
    tell : callable
        Called with kind and text of each event.

    Raises
    ------
    HostError
        The car has stopped computing steps.
    """
    columns = [(name, car.names.index(name)) for name in OBSERVED if name in car.names]
    _act(car, driver, columns)
    car.command("step", max(1, round(seconds / car.step)))
    last_count, since = -1, time.monotonic()
    try:
        with bar(total=seconds, bar_format=_BAR) as progress:
            while True:
                state = car.latest()
                for event in car.events():
                    progress.clear()
                    tell(event.kind, event.text)
                progress.update(min(state.time, seconds) - progress.n)
                if state.refused or state.time >= seconds - 0.5 * car.step:
                    return not state.refused
                now = time.monotonic()
                if state.count != last_count:
                    last_count, since = state.count, now
                elif now - since > _PATIENCE:
                    raise HostError(f"The car has computed no step for {_PATIENCE:g} s; the run is aborted.")
                _act(car, driver, columns)
                time.sleep(_PERIOD)
    finally:
        car.command("pause")


def _act(car: AliasedCar, driver: HeadlessDriver, columns: Sequence[tuple[str, int]]) -> None:
    state = car.latest()
    if inputs := driver.act(state.time, {name: float(state.values[k]) for name, k in columns}):
        car.want({name: (value, math.inf) for name, value in inputs.items()})
