"""The free length that the warning of a car out of its equilibrium gives."""

import copy
import re
import warnings

import pytest

from mbs.compiler.model_to_system import compiled
from mbs.simulation.unstepped_system import StandingSystem
from mbs.vehicle import CarFileError, CarWarning, load
from mbs.vehicle.built_car import checked_car
from mbs.vehicle.car import Car
from tests.quick import quick

CASES = {
    "longer": ("saloon", {"front": 0.03}),
    "both axles": ("hatchback", {"front": -0.04, "rear": 0.03}),
    "levers": ("prototype", {"front": 0.05, "rear": -0.04}),
    "curves": ("commonroad_320i", {"rear": 0.04}),
    "too far": ("saloon", {"front": 0.2}),
}


def said_of(car: Car, lengths: dict[str, float]) -> tuple[str, Car | None]:
    """What is said of a car with other free lengths, and the car, if it is one."""
    data = copy.deepcopy(car._data)
    for axle, length in lengths.items():
        data[axle]["spring"]["free_length"] = length
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", CarWarning)
        try:
            checked = checked_car(type(car), data, car.folder, "car", warn=True)
        except CarFileError as error:
            return str(error), None
    return "\n".join(str(entry.message) for entry in caught), checked


@pytest.mark.parametrize("case", quick(("longer", "curves"), CASES, "proof"))
def test_with_the_free_length_that_is_given_the_car_stands_as_drawn(case: str) -> None:
    name, changes = CASES[case]
    car = load(name)
    drawn = {axle: getattr(car, axle).spring.free_length for axle in changes}
    message, _ = said_of(car, {axle: drawn[axle] + change for axle, change in changes.items()})
    assert message.count("a car is drawn in its equilibrium: with ") == len(changes)
    lengths = {
        axle: float(value) for axle, value in re.findall(r"with (\w+)\.spring\.free_length = ([\d.]+) it is", message)
    }
    assert lengths.keys() == changes.keys()
    again, result = said_of(car, lengths)
    assert "equilibrium" not in again
    assert result is not None
    model = result.empty()
    result.build(model)
    model.look()
    at_rest = StandingSystem(compiled(model)).sensors
    for axle in changes:
        for side in "LR":
            assert abs(at_rest[f"wheel_{axle[0].upper()}{side}.travel"]) < 1e-3
        assert abs(sum(at_rest[f"wheel_{axle[0].upper()}{side}.travel"] for side in "LR")) < 4e-5


def test_a_parameter_of_a_standing_system_is_in_its_range() -> None:
    car = load("saloon")
    model = car.empty()
    car.build(model)
    model.look()
    with pytest.raises(ValueError, match=r"'front\.spring\.free_length' cannot be 99: "):
        StandingSystem(compiled(model), {"front.spring.free_length": 99.0})
