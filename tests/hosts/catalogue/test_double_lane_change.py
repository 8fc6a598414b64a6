"""The prototype car between cones: a limit speed, the measures of its run, and messages."""

import math
from dataclasses import replace

import numpy as np
import pytest

from ali3.iso_3888 import Gate
from hosts.catalogue.car import TestedCar
from hosts.catalogue.execution import perform, reason_against
from hosts.catalogue.registry import standard_test
from hosts.catalogue.standard import double_lane_change
from hosts.catalogue.standard.double_lane_change import _COURSES, DRIVERS, Passage, add_limit, find_limit
from hosts.catalogue.standard_test import TestRecord
from hosts.common.errors import HostError
from hosts.driving.course import Course
from hosts.driving.result import Result
from hosts.measures.measure import Measure
from tests.hosts.catalogue.measured import sheet_of, values

OBSTACLE = {"course": 2.0, "lowest": 60.0, "highest": 80.0, "increment": 10.0, "resolution": 5.0}
LANE = Course("lane", (Gate(10.0, 30.0, -1.5, 1.5),))


def passage(speed: float, aside: float, until: float = 50.0, driver: str = "centre line") -> Passage:
    """A car of 4 m by 2 m straight through one lane of 3 m, `aside` to the left of its middle, in turned axes."""
    x = np.linspace(0.0, until, 501)
    yaw, x0, y0 = 0.7, 5.0, -3.0
    columns = {
        "chassis.x": x0 + x * math.cos(yaw) - aside * math.sin(yaw),
        "chassis.y": y0 + x * math.sin(yaw) + aside * math.cos(yaw),
        "chassis.yaw": np.full_like(x, yaw),
        "speed": np.linspace(speed / 3.6, speed / 3.6 - 2.0, len(x)),
        "chassis.ay": -3.0 * np.sin(x / 10.0),
    }
    result = Result(
        list(columns),
        dict.fromkeys(columns, "1"),
        0.01 * np.arange(501),
        np.column_stack(list(columns.values())),
        0,
        5,
        0,
        [],
    )
    return Passage(speed, result, driver, LANE, (4.0, 2.0), (x0, y0, yaw), np.ones(501, bool), "", math.inf)


def test_clearance_and_speeds_are_taken_in_the_axes_of_the_course() -> None:
    clean = passage(72.0, 0.2)
    assert clean.is_clean
    assert clean.least_clearance == pytest.approx(0.3)
    measured = {m.name: m for m in measures_of("lane", clean)}
    # the front is at the lane after 8 m of 50
    assert measured["lane.entry_speed"].value == pytest.approx(20.0 - 2.0 * 8.0 / 50.0, abs=0.003)
    assert measured["lane.exit_speed"].value == pytest.approx(20.0 - 2.0 * 28.0 / 50.0, abs=0.003)
    assert measured["lane.ay.largest"].value == pytest.approx(3.0, rel=1e-3)
    assert math.isnan(measured["lane.roll.largest"].value)
    assert "chassis.roll" in measured["lane.roll.largest"].note


def measures_of(name: str, passed: Passage | None) -> list[Measure]:
    sheet = sheet_of("double_lane_change")
    add_limit(sheet, name, passed, None)
    return sheet.measures


def test_hit_or_stopped_is_not_clean() -> None:
    hit, stopped = passage(72.0, 0.6), passage(72.0, 0.0, until=29.0)
    assert not hit.is_clean
    assert "hit by 0.1 m" in hit.failure
    assert not stopped.is_clean
    assert "pass the course" in stopped.failure


def test_the_limit_is_found_by_bisection(monkeypatch: pytest.MonkeyPatch) -> None:
    tried = []

    def passage_of(car: object, layout: object, speed: float, driver: str) -> Passage:
        tried.append((speed, driver))
        # only the second driver gets through at all, and up to 77.3 km/h
        return passage(speed, 0.0 if speed < 77.3 and driver == list(DRIVERS)[1] else 1.0, driver=driver)

    monkeypatch.setattr(double_lane_change, "drive_through", passage_of)
    settings = {"lowest": 40.0, "highest": 160.0, "increment": 10.0, "resolution": 1.0}
    done: list[float] = []
    passed, failed, notes = find_limit(None, _COURSES[0], settings, done.append)  # type: ignore[arg-type]
    assert passed is not None
    assert failed is not None
    assert passed.target_speed < 77.3 <= failed.target_speed
    assert failed.target_speed - passed.target_speed <= 1.0
    assert passed.driver == list(DRIVERS)[1]
    # who got through is asked first from then on
    assert tried[2] == (50.0, list(DRIVERS)[1])
    assert done == sorted(done)
    assert 0.0 < done[-1] <= 1.0
    assert "a cone is hit" in notes[0]
    passed, failed, notes = find_limit(None, _COURSES[0], settings | {"highest": 70.0}, done.append)  # type: ignore[arg-type]
    assert failed is None
    assert "up to 70 km/h" in notes[0]
    passed, failed, notes = find_limit(None, _COURSES[0], settings | {"lowest": 80.0}, done.append)  # type: ignore[arg-type]
    assert passed is None
    assert "already at 80 km/h" in notes[0]


@pytest.fixture(scope="module")
def driven(prototype: TestedCar) -> TestRecord:
    return perform(standard_test("double_lane_change"), prototype, OBSTACLE)


@pytest.mark.slow
def test_prototype_has_a_limit_on_the_obstacle_course(driven: TestRecord) -> None:
    measured = values(driven)
    assert 60.0 / 3.6 <= measured["iso_3888_2.speed"] < 75.0 / 3.6
    assert measured["iso_3888_2.speed_hit"] - measured["iso_3888_2.speed"] <= 5.01 / 3.6
    assert 0.0 < measured["iso_3888_2.clearance"] < 0.2
    # the car rolls: it comes out slower than it went in
    assert measured["iso_3888_2.exit_speed"] < measured["iso_3888_2.entry_speed"] - 3.0 / 3.6
    assert measured["iso_3888_2.entry_speed"] == pytest.approx(measured["iso_3888_2.speed"], rel=0.02)
    # not beyond what friction can do
    assert 5.0 < measured["iso_3888_2.ay.largest"] < 1.35 * 9.81
    run = driven.runs["iso_3888_2_passed"]
    assert run["throttle"][-1] == run["brake"][-1] == 0.0
    assert any("depends on the driver" in note for note in driven.notes)


@pytest.mark.slow
def test_clearance_does_not_depend_on_the_step(prototype: TestedCar) -> None:
    least = [
        double_lane_change.drive_through(
            replace(prototype, step=step), _COURSES[1], 55.0, "least curvature, late"
        ).least_clearance
        for step in (0.001, 0.005)
    ]
    assert least[0] > 0.0
    assert least[1] == pytest.approx(least[0], abs=0.015)


def test_missing_variables_and_wrong_settings_are_reported(prototype: TestedCar) -> None:
    bare = replace(prototype)
    constants = {n: x for n, x in prototype.facts.constants.items() if n != "vehicle.width"}
    bare.__dict__["facts"] = replace(prototype.facts, constants=constants)
    assert "vehicle.width" in str(reason_against(standard_test("double_lane_change"), bare, {}))
    with pytest.raises(HostError, match="course is 1.5"):
        perform(standard_test("double_lane_change"), prototype, {"course": 1.5})
    with pytest.raises(HostError, match="lowest speed is 90"):
        perform(standard_test("double_lane_change"), prototype, {"lowest": 90.0, "highest": 80.0})


@pytest.mark.slow
def test_a_car_that_does_not_reach_the_speed_is_reported(prototype: TestedCar) -> None:
    slow = double_lane_change.drive_through(prototype, _COURSES[0], 240.0, next(iter(DRIVERS)))
    assert not slow.is_clean
    assert "the speed was not reached" in slow.failure


def test_a_value_at_a_position_that_the_car_did_not_reach_is_undefined() -> None:
    """The front is 2 m ahead of the centre: at 45 m the centre is at 43 m; at 60 m nothing was measured."""
    driven = passage(60.0, 0.0)
    assert driven.at("speed", 45.0) == pytest.approx(60.0 / 3.6 - 2.0 * 43.0 / 50.0, abs=0.01)
    assert math.isnan(driven.at("speed", 60.0))
    assert math.isnan(replace(driven, after=np.zeros(501, bool)).at("speed", 45.0))
