"""Each table of the cars' files left out: a car that drives, or a sentence that names the table."""

from __future__ import annotations

import warnings

import pytest

import mbs
from mbs.vehicle import CarFileError, car_names, load
from mbs.vehicle.car import car_from
from mbs.vehicle.changes import changed_content
from tests.vehicle.content import sentences, tables

TABLES = [(name, path) for name in car_names() for path in tables(load(name)._data)]
OPTIONAL = {
    *("chassis.accelerometers", "chassis.frame", "chassis.frame.gauges", "chassis.ground_contact", "payload"),
    *("front.stops", "rear.stops", "front.anti_roll_bar", "rear.anti_roll_bar", "front.suspension.steering_stop"),
}


def without(name, path):
    """The car without a table, and what is told of it."""
    car = load(name)
    data = changed_content(car._data, {}, "x")
    *outer, last = path.split(".")
    table = data
    for key in outer:
        table = table[key]
    del table[last]
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        found = car_from(data, car.folder, "x", warn=True)
    return found, [sentences(warning.message, "x: ") for warning in caught]


@pytest.mark.parametrize(("name", "path"), TABLES)
def test_a_car_or_a_sentence(name, path):
    named = path.rpartition(".")[0] in ("payload", "chassis.frame.gauges")  # of names that the user chooses
    try:
        car, _ = without(name, path)
    except CarFileError as error:
        assert path not in OPTIONAL
        assert not named
        (line,) = sentences(error, "x: ")
        assert "is missing" in line or "is not in chassis.frame.sections" in line
    else:
        assert path in OPTIONAL or named
        run = mbs.simulate(mbs.compile(car.model()), 0.1, 0.002, inputs={"throttle": 0.5}, estimate_error=False)
        assert run["speed"][-1] > 0.0


def test_without_points_that_touch_the_ground_there_is_no_work_of_it():
    car = mbs.compile(without("hatchback", "chassis.ground_contact")[0].model())
    run = mbs.simulate(car, 0.02, 0.002)
    assert not run["energy.ground"].any()
    assert "chassis.ground_force" not in [s["name"] for s in car.meta["sensors"]]
