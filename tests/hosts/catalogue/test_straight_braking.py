"""The prototype car stops: closed forms of force, load and energy, the step, and refusals."""

import math
from dataclasses import replace

import numpy as np
import pytest

from hosts.catalogue.car import TestedCar
from hosts.catalogue.execution import perform
from hosts.catalogue.registry import standard_test
from hosts.catalogue.standard_test import TestRecord
from hosts.driving.result import Result
from hosts.measures.measure import Measure
from tests.hosts.catalogue.measured import sheet_of, values


def measures_of(result: Result, onset: float) -> list[Measure]:
    """Of a stop from 72 km/h."""
    sheet = sheet_of("straight_braking", speed=72.0)
    sheet.add("stop", run=result, onset=onset)
    return sheet.measures


G = 9.81


@pytest.fixture(scope="module")
def gentle(prototype: TestedCar) -> TestRecord:
    """A pedal that locks no wheel."""
    return perform(standard_test("straight_braking"), prototype, {"pedal": 0.6})


def test_stop_is_that_of_its_forces(gentle: TestRecord) -> None:
    measured = values(gentle)
    a = measured["deceleration.mean_fully_developed"]
    assert not gentle.notes
    assert 6.0 < a < 10.0
    # constant deceleration after the rise: v^2 / 2a and half of the rise at full speed, as far as it is constant
    v = 100.0 / 3.6
    assert measured["stopping_distance.corrected"] == pytest.approx(v**2 / (2 * a) + 0.05 * v, rel=0.03)
    # no more than friction can hold
    assert a < 1.2705 * G
    # forces of the road stop the mass of the car but for the air, which takes a few per cent at this speed
    assert 0.9 < measured["energy.road_share"] < 1.0
    assert abs(measured["energy.error"]) < 1e-4


def test_loads_move_forward_by_the_moment_of_the_deceleration(gentle: TestRecord) -> None:
    measured, result = values(gentle), gentle.runs["straight_braking"]
    a = measured["deceleration.mean_fully_developed"]
    loads = [result[f"wheel_{w}.Fz"][0] for w in ("FL", "FR", "RL", "RR")]
    moved = measured["front_share.braking"] - sum(loads[:2]) / sum(loads)
    # share of the weight that moves = a h / (g L); the spin of the wheels adds about a tenth, the drag takes some
    height = moved * 2.3 * G / a
    assert height == pytest.approx(result["chassis.z"].mean(), rel=0.12)
    # both axles together brake with a / g but for the air
    used = measured["front_share.braking"] * measured["utilisation.front"]
    used += (1.0 - measured["front_share.braking"]) * measured["utilisation.rear"]
    assert used == pytest.approx(a / G, rel=0.05)
    assert used < a / G
    assert abs(measured["deviation.lateral"]) < 1e-6


@pytest.mark.slow
def test_locked_wheels_are_reported(prototype: TestedCar) -> None:
    record = perform(standard_test("straight_braking"), prototype)
    measured = values(record)
    assert measured["locked_time.FL"] > 0.99
    assert measured["slip.front"] == measured["slip.rear"] == 1.0  # against the carrier, which pitches
    assert any("lock" in note for note in record.notes)
    limits = {m.name: m.is_kept for m in record.measures if m.limit is not None}
    assert limits["locked_time.FL"] is False
    assert limits["deceleration.mean_fully_developed"] is True
    # the best pedal that locks no wheel, and it is one
    assert 0.5 < measured["unlocked.pedal"] < 1.0
    checked = values(perform(standard_test("straight_braking"), prototype, {"pedal": measured["unlocked.pedal"]}))
    assert max(checked[f"locked_time.{w}"] for w in ("FL", "FR", "RL", "RR")) == 0.0
    assert checked["stopping_distance"] == pytest.approx(measured["unlocked.stopping_distance"], rel=1e-9)
    harder = values(perform(standard_test("straight_braking"), prototype, {"pedal": measured["unlocked.pedal"] + 0.02}))
    assert max(harder[f"locked_time.{w}"] for w in ("FL", "FR", "RL", "RR")) > 0.0


@pytest.mark.slow
def test_results_do_not_depend_on_the_step(prototype: TestedCar, gentle: TestRecord) -> None:
    fine = values(gentle)
    for step in (0.001, 0.005):
        coarse = values(perform(standard_test("straight_braking"), replace(prototype, step=step), {"pedal": 0.6}))
        assert coarse["stopping_distance.corrected"] == pytest.approx(fine["stopping_distance.corrected"], rel=1e-3)
        mean = "deceleration.mean_fully_developed"
        assert coarse[mean] == pytest.approx(fine[mean], rel=1e-3)
        assert coarse["pitch.largest"] == pytest.approx(fine["pitch.largest"], rel=1e-2)
        assert coarse["deceleration.time_to_90"] == pytest.approx(fine["deceleration.time_to_90"], abs=5e-3)


@pytest.mark.slow
def test_a_car_too_weak_for_the_speed_is_reported(prototype: TestedCar) -> None:
    record = perform(standard_test("straight_braking"), prototype, {"speed": 250.0})
    assert any("250 km/h" in note for note in record.notes)
    assert all(math.isnan(m.value) and m.note for m in record.measures if "stopping" in m.name)


def test_a_car_with_speed_as_its_only_output() -> None:
    time = np.arange(0.0, 6.0, 0.01)
    speed = np.clip(20.0 - 5.0 * (time - 1.0), 0.0, 20.0)
    result = Result(["speed"], {"speed": "m/s"}, time, speed[:, None], 0.0, 6.0, 0, [])
    measures = {m.name: m for m in measures_of(result, 1.0)}
    assert measures["stopping_distance.corrected"].value == pytest.approx(40.0, rel=1e-4)
    assert measures["deceleration.mean_fully_developed"].value == pytest.approx(5.0, rel=1e-9)
    assert measures["deceleration.largest"].value == pytest.approx(5.0, rel=1e-9)
    without = [m for m in measures.values() if math.isnan(m.value)]
    assert len(without) > 10
    assert all(m.note and m.is_kept is None for m in without)


def test_the_deviation_is_beside_the_line_of_travel() -> None:
    time = np.arange(0.0, 6.0, 0.01)
    speed = np.clip(20.0 - 5.0 * (time - 1.0), 0.0, 20.0)
    distance = np.cumsum(speed) * 0.01
    heading, side = 0.5, 0.3 * np.clip(time - 1.0, 0.0, 1.0)
    x = distance * math.cos(heading) - side * math.sin(heading)
    y = distance * math.sin(heading) + side * math.cos(heading)
    names = ["speed", "chassis.x", "chassis.y", "chassis.yaw"]
    values = np.column_stack([speed, x, y, np.full_like(time, heading)])
    result = Result(names, dict.fromkeys(names, "1"), time, values, 0.0, 6.0, 0, [])
    measures = {m.name: m.value for m in measures_of(result, 1.0)}
    assert measures["deviation.lateral"] == pytest.approx(0.3, abs=1e-9)


def test_a_car_that_cannot_be_started_at_speed_gathers_it(prototype: TestedCar) -> None:
    bare, settings = replace(prototype), {"speed": 40.0, "pedal": 0.6}
    parameters = tuple(n for n in prototype.facts.parameters if n != "initial.speed")
    bare.__dict__["facts"] = replace(prototype.facts, parameters=parameters)
    slow, fast = (values(perform(standard_test("straight_braking"), car, settings)) for car in (bare, prototype))
    assert slow["initial_speed"] == pytest.approx(40.0 / 3.6, abs=0.06)
    for name in ("stopping_distance.corrected", "deceleration.mean_fully_developed"):
        assert slow[name] == pytest.approx(fast[name], rel=0.02)
