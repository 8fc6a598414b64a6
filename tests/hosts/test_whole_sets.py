"""Parameter sets of a car: one with all values of the FMU, as a build writes it, changes nothing in a command."""

import json
from collections.abc import Mapping
from pathlib import Path

import fmpy
import numpy as np
import pytest
from fmpy.util import read_csv

from ali3.write_parameter_set import write_parameter_set
from hosts.catalogue.car import cars_of
from hosts.common.errors import HostError
from hosts.common.numbers import Value
from hosts.fmu.parameters_as_set import parameter_set_of
from hosts.fmu.settings import START_OF, Settings
from hosts.fmu.variables import Variables
from hosts.run.command import main as run
from hosts.simulator.command import main as simulator


@pytest.fixture
def variables(prototype_fmu: Path) -> Variables:
    return Variables(fmpy.read_model_description(str(prototype_fmu)))


def whole_set(variables: Variables, file: Path, values: Mapping[str, Value] | None = None) -> Path:
    """Of all parameters of the FMU, some with other values."""
    write_parameter_set(parameter_set_of(variables, "car", values or {}), file, as_built=False)
    return file


def test_it_keeps_the_values_of_a_manoeuvre_or_a_world(variables, tmp_path):
    whole = whole_set(variables, tmp_path / "whole.ssv", {"front.tyre.grip": 0.9})
    settings = Settings(variables)
    settings.add_numbers({"road.friction": 0.5, "initial.x": 7.0}, "the world")
    settings.add_numbers({"initial.speed": 22.0}, f"{START_OF}step")
    settings.add_set(whole)
    kept = {"road.friction": 0.5, "initial.x": 7.0, "initial.speed": 22.0}
    assert settings.start == {**kept, "front.tyre.grip": 0.9}
    assert ("initial.speed", "that of start of step stays: in whole.ssv it is as in the FMU") in settings.rows()
    settings.add_set(whole_set(variables, tmp_path / "other.ssv", {"initial.speed": 5.0}))
    assert settings.start["initial.speed"] == 5.0


@pytest.mark.slow
def test_a_manoeuvre_is_driven_as_without_it(variables, prototype_fmu, tmp_path):
    whole = whole_set(variables, tmp_path / "whole.ssv")
    results = []
    for name, more in (("without", []), ("with", ["--parameters", str(whole)])):
        out = ["--stop-time", "0.1", "--out", str(tmp_path / name)]
        assert run([str(prototype_fmu), "-m", "step_steer", *out, *more]) == 0
        results.append(read_csv(next((tmp_path / name).glob("*.csv"))))
    assert results[0]["speed"][0] > 20.0
    assert all(np.array_equal(results[0][name], results[1][name]) for name in results[0].dtype.names)


def test_the_catalogue_takes_it_and_refuses_another_start(variables, prototype_fmu, tmp_path):
    whole = whole_set(variables, tmp_path / "whole.ssv", {"front.tyre.grip": 0.9})
    (car,) = cars_of([prototype_fmu], [], [whole], [], None)
    assert car.start == {"front.tyre.grip": 0.9}
    fast = whole_set(variables, tmp_path / "fast.ssv", {"initial.speed": 5.0})
    with pytest.raises(HostError, match=r"'initial\.speed' of .* cannot be given: the tests themselves"):
        cars_of([prototype_fmu], [], [fast], [], None)


@pytest.mark.slow
def test_the_simulator_keeps_its_world_and_place(variables, prototype_fmu, tmp_path):
    whole = whole_set(variables, tmp_path / "whole.ssv")
    results = []
    for more in ([], ["--parameters", str(whole)]):
        record = tmp_path / f"{len(results)}.json"
        arguments = [str(prototype_fmu), "--headless", "--world", "kerb", "--stop-time", "0.1", "--json", str(record)]
        assert simulator([*arguments, *more]) == 0
        results.append(json.loads(record.read_text())["settings"])
    assert results[0] == results[1]
    assert any(entry["name"] == "road.file" for entry in results[1])


def test_a_ratio_that_is_set_is_reported_beside_the_constants_of_the_file(variables):
    """Half the travel per turn: twice the angle to full lock and the ratio; without it nothing is told."""
    settings = Settings(variables)
    assert not settings.rows()
    drawn = variables["steering.rack_per_turn"].start
    assert isinstance(drawn, float)
    settings.add_numbers({"steering.rack_per_turn": 0.5 * drawn}, "--set")
    rows = dict(settings.rows())
    for name in ("vehicle.steering_wheel_angle_max", "vehicle.steering_ratio"):
        constant = variables[name].start
        assert isinstance(constant, float)
        assert rows[name].startswith(f"constant {constant:.6g} of the FMU")
        assert float(rows[name].split()[-1]) == pytest.approx(2.0 * constant, rel=1e-5)
        assert "ratio of the car file" in variables[name].description
