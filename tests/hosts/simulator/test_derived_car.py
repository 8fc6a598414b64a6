"""A car seen through aliases has its derived variables too, and they follow jumps of its time."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from hosts.fmu.aliases.alias import Alias, Aliases
from hosts.fmu.aliases.derived_variable import parse_derived
from hosts.fmu.fmu_source import FmuSource
from hosts.simulator.aliased_car import AliasedCar
from hosts.simulator.car_events import CarState

ALIASES = Aliases(
    (Alias("steering", "StrAng", -540.0), Alias("chassis.x", "X", 1000.0)),
    derived=(
        parse_derived("chassis.vx", "rate(chassis.x)", {}, "here"),
        parse_derived("speed", "length(chassis.vx, 0)", {}, "here"),
    ),
)


class Sledge:
    """What `AliasedCar` needs of a car: it moves 2 m/s forward."""

    names, inputs, units, constants, step = ("StrAng", "X"), ("StrAng",), {"StrAng": "deg", "X": "mm"}, {}, 0.01

    def __init__(self):
        self.time = 0.0

    def latest(self):
        moment = CarState.__new__(CarState)
        for name in CarState.__dataclass_fields__:
            object.__setattr__(moment, name, 0)
        return replace(moment, time=self.time, values=np.array([270.0, 2000.0 * self.time]))


def test_derived_values_come_after_those_of_the_car():
    sledge = Sledge()
    car = AliasedCar(sledge, FmuSource(Path(), ALIASES))
    assert car.names == ("steering", "chassis.x", "chassis.vx", "speed")
    assert car.inputs == ("steering",)
    assert set(car.units) == set(car.names)
    assert np.isnan(car.latest().values[2:]).all()
    for k in range(1, 5):
        sledge.time = 0.01 * k
        assert car.latest().values == pytest.approx([-0.5, 0.02 * k, 2.0, 2.0])
        assert car.latest().values == pytest.approx([-0.5, 0.02 * k, 2.0, 2.0])  # asked twice in a step
    sledge.time = 0.0
    assert np.isnan(car.latest().values[2:]).all()
