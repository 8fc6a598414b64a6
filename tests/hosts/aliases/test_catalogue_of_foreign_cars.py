"""A test of the catalogue gives the same measures of the same car in whatever names it has."""

import math
from pathlib import Path

import pytest

from hosts.catalogue.car import TestedCar
from hosts.catalogue.execution import missing_for, perform
from hosts.catalogue.registry import standard_test
from hosts.common.errors import HostError
from hosts.fmu.aliases.alias import Aliases
from hosts.fmu.aliases.file import find_aliases
from hosts.fmu.fmu import described
from hosts.fmu.fmu_source import FmuSource
from hosts.fmu.variables import Variables

CONSTANTS = {
    "vehicle.steering_wheel_angle_max": 8.0,
    "brake_pressure_max": 12e6,
    "centre_of_mass.x": 0.35,
    "centre_of_mass.y": 0.0,
    "centre_of_mass.z": -0.25,
}
# Accelerations: of Chrono as differences over 10 ms, of OSI their part from the turning, of CarSim level.
TOLERANCES = {"carmaker": 1e-6, "carsim": 5e-3, "chrono": 2e-2, "osi": 5e-3, "vehicle_interfaces": 1e-6}


@pytest.fixture(scope="module")
def step_steer(foreign_fmu):
    """The measures of a car by name."""
    test = standard_test("step_steer")

    def measures(style: str, file: Path | None) -> dict[str, float]:
        fmu = foreign_fmu(style)
        variables = Variables(described(fmu))
        aliases = Aliases(constants=CONSTANTS) if file is None else find_aliases(file, variables)
        car = TestedCar(style, FmuSource(fmu, aliases), step=0.01)
        assert missing_for(test, car, {s.name: s.value for s in test.settings}) is None
        return {m.name: m.value for m in perform(test, car).measures}

    return measures


@pytest.fixture(scope="module")
def ours(step_steer):
    return step_steer("ours", None)


@pytest.fixture
def file(tmp_path):
    def write(style, entries=""):
        alias_file = tmp_path / f"{style}.toml"
        numbers = "\n".join(f'"{name}" = {value}' for name, value in CONSTANTS.items())
        alias_file.write_text(f'extends = "{style}"\n{entries}\n[constants]\n{numbers}', encoding="utf-8")
        return alias_file

    return write


SLOW = ("carsim", "chrono")  # the most that differs; of the others `test_foreign_cars.py` sees each value


@pytest.mark.slow
@pytest.mark.parametrize("style", [pytest.param(s, marks=[pytest.mark.proof] * (s not in SLOW)) for s in TOLERANCES])
def test_measures_are_the_same(style, step_steer, ours, file):
    theirs = step_steer(style, file(style))
    assert theirs.keys() == ours.keys()
    assert sum(map(math.isfinite, ours.values())) > 10
    for name, value in ours.items():
        assert theirs[name] == pytest.approx(value, rel=TOLERANCES[style], abs=1e-9, nan_ok=True), name


def test_a_turned_sign_is_reported(step_steer, file):
    turned = file("carmaker", '"chassis.wz" = { name = "Car.YawRate", factor = -1.0 }')
    with pytest.raises(HostError, match=r"the other sign of 'chassis\.wz'"):
        step_steer("carmaker", turned)
