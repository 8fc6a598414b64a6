"""A car of another program under our names, in our units and signs, moves as ours."""

import math
from pathlib import Path

import numpy as np
import pytest

from hosts.catalogue.car import TestedCar
from hosts.common.errors import HostError
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.pilots.combined_pilot import CombinedPilot
from hosts.driving.pilots.speed_holder import SpeedHolder
from hosts.driving.pilots.steering_table import SteeringTable
from hosts.driving.result import Result
from hosts.fmu.aliases.alias import Alias, Aliases
from hosts.fmu.fmu_source import FmuSource
from tests.hosts.changed_fmu import DESCRIPTION, changed_fmu

NAMES = {
    "steering": "Driver.Steer",
    "speed": "Car.v",
    "chassis.ay": "Car.ay",
    "chassis.wz": "Car.YawRate",
    "initial.speed": "Start.v",
    "vehicle.wheelbase": "Car.WheelBase",
    "chassis.x": "Car.tx",
}
SCALES = {"steering": -1.0, "chassis.wz": -2.0}


@pytest.fixture(scope="module")
def foreign(prototype_fmu: Path, tmp_path_factory: pytest.TempPathFactory) -> TestedCar:
    """The prototype under other names; the numbers of some mean others of ours."""
    path = tmp_path_factory.mktemp("foreign") / "foreign.fmu"

    def renamed(content: bytes) -> bytes:
        text = content.decode()
        for ours, theirs in NAMES.items():
            assert f'name="{ours}"' in text
            text = text.replace(f'name="{ours}"', f'name="{theirs}"')
        return text.encode()

    changed_fmu(prototype_fmu, path, {DESCRIPTION: renamed})
    aliases = tuple(Alias(ours, theirs, SCALES.get(ours, 1.0)) for ours, theirs in NAMES.items())
    return TestedCar("foreign", FmuSource(path, Aliases(aliases, {"vehicle.length": 9.0})))


def drive(car: TestedCar, sign: float = 1.0, record_step: float | None = None) -> Result:
    pilot = CombinedPilot(SpeedHolder(15.0), SteeringTable([0.0, 0.3, 0.6], [0.0, 0.0, sign * 0.1]))
    manoeuvre = Manoeuvre("turn", np.zeros(0), {}, 2.0, {"initial.speed": 15.0})
    return car.drive(manoeuvre, pilot, lambda t, s: s["chassis.ay"] > 3.0, record_step)


def test_a_foreign_car_is_driven_to_the_same_bits(prototype: TestedCar, foreign: TestedCar) -> None:
    """Factors of -1 and -2 are exact, so that nothing may differ: inputs turn round twice, or in the car and back."""
    ours, theirs = drive(prototype), drive(foreign, -1.0)
    assert theirs.names == ours.names
    assert theirs.time.tolist() == ours.time.tolist()
    for name in ours.names:
        factor = SCALES.get(name, 1.0)
        assert (factor * theirs[name] == ours[name]).all(), name
    assert theirs.units["chassis.ay"] == "m/s2"
    assert theirs.units["chassis.wz"] == "rad/s"
    assert ours["chassis.ay"][-1] > 3.0
    assert ours.time[-1] < 2.0


def test_rows_that_are_recorded_more_rarely_are_the_same_rows(prototype: TestedCar) -> None:
    each, some = drive(prototype), drive(prototype, record_step=0.02)
    assert some.time == pytest.approx(each.time[::10])
    assert (some.values == each.values[::10]).all()


def test_facts_are_under_our_names(foreign: TestedCar) -> None:
    assert "steering" in foreign.facts.inputs
    assert "chassis.ay" in foreign.facts.outputs
    assert "initial.speed" in foreign.facts.parameters
    assert foreign.facts.constants["vehicle.wheelbase"] == 2.3
    assert foreign.facts.constants["vehicle.length"] == 9.0
    assert foreign.facts.step == 0.002


def test_variables_that_a_pilot_lacks_are_named(prototype: TestedCar) -> None:
    still = Manoeuvre("still", np.zeros(0), {}, 0.1)
    with pytest.raises(HostError, match="variables that .* does not have: oars"):
        prototype.drive(still, SteeringTable([0.0], [0.0], "oars"))

    class Blind:
        def act(self, time: float, observation: dict[str, float]) -> dict[str, float]:
            return {"steering": observation["eyes"]}

    with pytest.raises(HostError, match="needs the output 'eyes'"):
        prototype.drive(still, Blind())

    class Careful:
        def act(self, time: float, observation: dict[str, float]) -> dict[str, float]:
            return {"steering": 0.25 if observation.get("eyes") is None and "eyes" not in observation else 0.5}

    assert prototype.drive(still, Careful())["steering"][-1] == 0.25


def test_a_pilot_that_asks_for_nothing_is_reported(prototype: TestedCar) -> None:
    turn = SteeringTable([0.0, 0.1, 0.2], [0.0, 0.0, math.nan])
    with pytest.raises(HostError, match="At 0.1.* s the driver asks for steering = nan."):
        prototype.drive(Manoeuvre("blank", np.zeros(0), {}, 0.3), turn)


def test_start_values_of_the_test_override_those_of_the_car(prototype_fmu: Path) -> None:
    car = TestedCar("slow", FmuSource(prototype_fmu), start={"initial.speed": 3.0, "initial.yaw": 0.5})
    rest = Manoeuvre("rest", np.zeros(0), {}, 0.01)
    result = car.drive(rest)
    assert result["chassis.yaw"][0] == pytest.approx(0.5)
    assert result["speed"][0] == pytest.approx(3.0, abs=0.01)
    moved = car.drive(Manoeuvre("fast", np.zeros(0), {}, 0.01, {"initial.speed": 9.0}))
    assert moved["speed"][0] == pytest.approx(9.0, abs=0.02)
    assert math.isfinite(moved["chassis.ay"][-1])
