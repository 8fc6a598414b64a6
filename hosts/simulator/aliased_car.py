"""A car of the simulator under ALi3 names."""

from collections.abc import Mapping
from dataclasses import replace

from hosts.common.numbers import Value
from hosts.fmu.fmu_source import FmuSource
from hosts.simulator.car import Car, CarState, Event
from hosts.simulator.step_times import StepTimes


class AliasedCar:
    """A `Car` under aliases; without aliases all values are those of the car.

    Attributes
    ----------
    names, inputs : tuple of str
        ALi3 names; in `names`, names of derived variables follow.
    units : dict of str to str
        Of the names; "" for converted values.
    constants : dict of str to float
        Constants of the FMU and of the alias file.
    step : float
        Communication step, s.
    """

    def __init__(self, car: Car, source: FmuSource) -> None:
        self._car, self._source = car, source
        self._row = source.row(car.names)
        self.names = self._row.names
        self.inputs = source.called(car.inputs)
        self.step = car.step
        their_names = dict(zip(self.names, car.names, strict=False))
        self.units = {n: "" if n in self._row.changed else car.units[their_names[n]] for n in self.names}
        self.constants = {**car.constants, **source.constants}

    def want(self, values: Mapping[str, tuple[float, float]]) -> None:
        self._car.want(self._source.inputs(values))

    def command(self, name: str, value: float = 0.0) -> None:
        self._car.command(name, value)

    def restart(self, changes: Mapping[str, Value]) -> None:
        self._car.restart(self._source.fmu_values(changes))

    def latest(self) -> CarState:
        moment = self._car.latest()
        values = self._row.of(moment.time, moment.values)
        return moment if values is moment.values else replace(moment, values=values)

    def events(self) -> list[Event]:
        return self._car.events()

    def step_times(self) -> StepTimes:
        return self._car.step_times()
