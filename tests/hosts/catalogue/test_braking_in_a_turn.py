"""Stops from a circle: closed forms of a synthetic turn, both sides of the prototype car, the step, refusals."""

import math
from dataclasses import replace

import pytest

from hosts.catalogue.car import TestedCar
from hosts.catalogue.circle_stop import Stop
from hosts.catalogue.execution import perform
from hosts.catalogue.registry import standard_test
from hosts.catalogue.standard.braking_in_a_turn import add_stops
from hosts.catalogue.standard_test import TestRecord
from hosts.common.errors import HostError
from hosts.measures.measure import Measure
from tests.hosts.catalogue.made_turn import turn
from tests.hosts.catalogue.measured import sheet_of, values

TEST = standard_test("braking_in_a_turn")
FEW = {"levels": 2.0, "pedal": 0.3, "deceleration": 4.0}


def measures_of(stops: list[Stop], deceleration: float) -> dict[str, Measure]:
    sheet = sheet_of("braking_in_a_turn", deceleration=deceleration)
    add_stops(sheet, stops)
    return {m.name: m for m in sheet.measures}


@pytest.mark.parametrize("radius", [80.0, -80.0])
def test_measures_of_a_made_turn(radius: float) -> None:
    stops = [turn(a, 1.2, radius, 0.4) for a in (3.0, 5.0)]
    measured = measures_of(stops, 4.0)
    value = {name: m.value for name, m in measured.items()}
    assert value["steady.radius"] == pytest.approx(80.0, rel=1e-6)
    assert value["steady.ay"] == pytest.approx(400.0 / 80.0, rel=1e-6)
    assert value["steady.yaw_rate"] == pytest.approx(20.0 / radius, rel=1e-3)
    assert value["yaw_rate.ratio"] == pytest.approx(1.2, rel=1e-6)
    # halfway between both stops: 20 % of (17 + 15) / 2 m/s over 80 m
    assert value["yaw_rate.change"] == pytest.approx(0.2 * 16.0 / 80.0, rel=1e-6)
    assert value["sideslip.change"] == pytest.approx(-0.05, rel=1e-3)
    assert value["path.deviation"] == pytest.approx(0.4, abs=1e-4)
    assert value["ay.ratio"] == pytest.approx(1.0, rel=1e-6)
    assert value["deceleration.largest"] == pytest.approx(5.0, rel=1e-6)
    assert math.isnan(value["lock.deceleration"])
    assert "slip" in measured["lock.deceleration"].note


def test_a_deceleration_that_no_stop_has_is_reported() -> None:
    measured = measures_of([turn(3.0, 1.0, 80.0, 0.0)], 6.0)
    assert math.isnan(measured["yaw_rate.ratio"].value)
    assert "3 to 3 m/s²" in measured["yaw_rate.ratio"].note
    assert measured["worst.yaw_rate.ratio"].value == pytest.approx(1.0)


@pytest.fixture(scope="module")
def left(prototype: TestedCar) -> TestRecord:
    return perform(TEST, prototype, FEW)


@pytest.mark.slow
def test_prototype_brakes_from_the_circle_that_was_asked_for(left: TestRecord) -> None:
    measured = values(left)
    assert not left.notes
    assert measured["steady.radius"] == pytest.approx(100.0, rel=0.01)
    assert measured["steady.ay"] == pytest.approx(5.0, rel=0.02)
    assert measured["steady.yaw_rate"] == pytest.approx(measured["steady.speed"] / measured["steady.radius"], rel=5e-3)
    # load moves to the front wheels, which turn the car in
    assert measured["yaw_rate.ratio"] > 1.05
    assert measured["path.deviation"] < 0.0


@pytest.mark.slow
def test_right_is_the_mirror_of_left_and_the_step_does_not_matter(prototype: TestedCar, left: TestRecord) -> None:
    right = values(perform(TEST, replace(prototype, step=0.002), FEW | {"radius": -100.0}))
    odd = ("steady.yaw_rate", "steady.sideslip")
    for name, value in values(left).items():
        if not math.isnan(value):
            expected = -value if name in odd else value
            assert right[name] == pytest.approx(expected, rel=0.03, abs=2e-3), name


def test_a_circle_that_cannot_be_held_is_reported(prototype: TestedCar) -> None:
    record = perform(TEST, prototype, FEW | {"lateral_acceleration": 14.0, "radius": 60.0})
    assert record.notes
    assert "asked for" in record.notes[-1] or "did not get onto" in record.notes[-1]


@pytest.mark.parametrize(("setting", "value"), [("radius", 5.0), ("levels", 2.5)])
def test_wrong_settings(prototype: TestedCar, setting: str, value: float) -> None:
    with pytest.raises(HostError, match=f"{setting}.*{value:g}"):
        perform(TEST, prototype, {setting: value})
