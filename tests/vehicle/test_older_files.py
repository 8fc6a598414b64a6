"""Files of schema 1 are read, say what was written in, and are the same car."""

from __future__ import annotations

import copy
import warnings
from dataclasses import replace

import pytest

from mbs.elements import PlaneRoad
from mbs.vehicle import CarFileError, car_names, load
from mbs.vehicle.car import car_from
from tests.elements.test_tyre_steady import steady
from tests.elements.tyre_data import TYRE, tyre_element
from tests.vehicle.content import sentences

STORED = {
    ("hatchback", 900.0, 1.0, 0.03, -0.02): (-409.03940942226734, 307.673597059443, -5.625828549106576),
    ("hatchback", 2400.0, 1.2705, -0.2, 0.1): (2668.9758359614307, -1339.0439750966789, 20.620959682271483),
    ("hatchback", 4000.0, 0.4, 0.5, 0.9): (-605.2348237807546, -970.074044156053, 0.0),
    ("prototype", 900.0, 1.0, 0.03, -0.02): (-411.28267259574784, 288.1104961233508, -5.468671760012043),
    ("prototype", 2400.0, 1.2705, -0.2, 0.1): (2678.3799106772994, -1124.6462423761416, 22.86728152809724),
    ("prototype", 4000.0, 0.4, 0.5, 0.9): (-672.620004952942, -803.1193017592926, 0.0),
}
"""Forces and moment of the tyres of each car, by load, friction of the road and slips, of the release that scaled them
by the largest longitudinal force over the nominal load."""


def first_form(name):
    """The content of a car of the package as a file of schema 1 had it."""
    data = copy.deepcopy(load(name)._data)
    data["schema"] = 1
    for axle in ("front", "rear"):
        del data[axle]["tyre"]["reference_friction"]
    if "motor_inertia" in data["drive"]:
        data["drive"]["rotor_inertia"] = 0.5 * data["drive"].pop("motor_inertia") * data["drive"]["ratio"] ** 2
    return data


def read(data, name):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        car = car_from(data, load(name).folder, "x", warn=True)
    return car, [line for warning in caught for line in sentences(warning.message, "x: ")]


@pytest.mark.parametrize("name", [n for n in car_names() if load(n).front.tyre.kind == "tmeasy"])
def test_it_is_the_same_car_and_says_so(name):
    car, told = read(first_form(name), name)
    (line,) = [line for line in told if "schema is 1" in line]
    for axle in ("front", "rear"):
        assert f"{axle}.tyre.reference_friction = {getattr(load(name), axle).tyre.reference_friction!r}" in line
    if name == "hatchback":
        assert f"drive.motor_inertia = {load(name).drive.motor_inertia!r} in place of drive.rotor_inertia" in line
    assert car.model_dump() == load(name).model_dump()


def test_a_rotor_without_a_ratio_is_a_sentence():
    for ratio in (None, "9", 0.0, -9.0, 10**400):
        data = first_form("hatchback")
        data["drive"]["ratio"] = ratio
        with pytest.raises(CarFileError, match=r"drive\.ratio"):
            read(data, "hatchback")


@pytest.mark.parametrize("axle", ["front", "rear"])
@pytest.mark.parametrize("case", STORED)
def test_its_tyres_have_the_forces_of_before(case, axle):
    name, weight, friction, *slips = case
    body = {key: getattr(TYRE, key) for key in ("radius", "bottoming_radius", "stiffness", "bottoming_stiffness")}
    for car in (load(name), read(first_form(name), name)[0]):
        tyre = replace(getattr(car, axle).tyre.tyre(), **body)  # of the wheel that `steady` holds
        out = steady(weight, *slips, tyre_element(tyre, PlaneRoad(friction=friction))).out
        found = out["longitudinal_force"], out["lateral_force"], out["aligning_moment"]
        assert found == pytest.approx(STORED[case], rel=1e-12, abs=1e-12)


@pytest.mark.parametrize("value", [None, "1500", 0, 0.0, [], {}, 10**400])
@pytest.mark.parametrize("key", ["tyre", "longitudinal", "nominal_load"])
def test_what_cannot_be_converted_is_a_sentence(key, value):
    data = first_form("prototype")
    table = data["front"] if key == "tyre" else data["front"]["tyre"]
    table[key] = value
    with pytest.raises(CarFileError) as error:
        read(data, "prototype")
    assert any(f"front.tyre.{key}".replace("tyre.tyre", "tyre") in line for line in sentences(error.value, "x: "))
