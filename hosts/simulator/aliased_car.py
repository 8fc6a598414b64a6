"""A car whose variables have our names."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from hosts.common.numbers import Value
from hosts.fmu.aliases.alias import Aliases
from hosts.fmu.aliases.derivation import Derivation
from hosts.simulator.car import Car, Event, Moment
from hosts.simulator.step_times import StepTimes


class AliasedCar:
    """A `Car` seen through aliases; with none of them it is the car as it is.

    Attributes
    ----------
    names, inputs : tuple of str
        Ours, where there are aliases; after those of the car, `names` has the derived ones.
    units : dict of str to str
        Of the names; "" where a factor or an offset changes the number.
    constants : dict of str to float
        Of the FMU, and those of the aliases.
    step : float
        s.
    """

    def __init__(self, car: Car, aliases: Aliases) -> None:
        self._car = car
        self._aliases = aliases
        ours = aliases.names(car.names)
        self._derivation = Derivation(aliases.derived, ours)
        self.names = (*ours, *self._derivation.names)
        self.inputs = aliases.names(car.inputs)
        self.step = car.step
        self._factors, self._offsets = aliases.scales(car.names)
        self._plain = bool((self._factors == 1.0).all() and (self._offsets == 0.0).all())
        scaled = (self._factors != 1.0) | (self._offsets != 0.0)
        self.units = {
            ours: "" if changed else car.units[theirs]
            for ours, theirs, changed in zip(ours, car.names, scaled, strict=True)
        } | dict.fromkeys(self._derivation.names, "")
        self.constants = {**car.constants, **aliases.constants}

    def want(self, values: Mapping[str, tuple[float, float]]) -> None:
        self._car.want(self._aliases.inputs(values))

    def command(self, name: str, value: float = 0.0) -> None:
        self._car.command(name, value)

    def restart(self, changes: Mapping[str, Value]) -> None:
        self._car.restart(self._aliases.values(changes))

    def latest(self) -> Moment:
        moment = self._car.latest()
        values = moment.values if self._plain else (moment.values - self._offsets) / self._factors
        if self._derivation.names:
            values = np.append(values, self._derivation.live(moment.time, values))
        return moment if values is moment.values else replace(moment, values=values)

    def events(self) -> list[Event]:
        return self._car.events()

    def step_times(self) -> StepTimes:
        return self._car.step_times()
