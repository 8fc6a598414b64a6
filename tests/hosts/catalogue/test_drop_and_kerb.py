"""The prototype car falls and drives over a kerb: free fall, balance of forces, step of communication."""

import math
from dataclasses import replace

import numpy as np
import pytest

from hosts.catalogue.car import TestedCar
from hosts.catalogue.execution import perform
from hosts.catalogue.registry import standard_test
from hosts.catalogue.standard_test import TestRecord
from tests.hosts.catalogue.measured import values


@pytest.fixture(scope="module")
def fallen(prototype: TestedCar) -> TestRecord:
    return perform(standard_test("drop"), prototype)


@pytest.fixture(scope="module")
def over_kerb(prototype: TestedCar) -> TestRecord:
    return perform(standard_test("kerb"), prototype)


def test_car_falls_freely_and_rests_on_its_weight(fallen: TestRecord) -> None:
    result, measured = fallen.runs["drop"], values(fallen)
    assert not fallen.notes
    assert all(m.is_kept is not False for m in fallen.measures)
    assert measured["fall.acceleration"] == pytest.approx(9.81, rel=5e-4)
    assert abs(measured["rest.load_error"]) < 1e-4
    # The weight is that of gravity's own book-keeping: energy given up in the air over the height that goes with it.
    falling = result.time < measured["contact.time"] - 0.004
    energy, time = -np.diff(result["energy.gravity"][falling])[-1], result.time[falling]
    middle = 0.5 * (time[-1] + time[-2])
    assert energy == pytest.approx(measured["rest.weight"] * 9.81 * middle * 0.002, rel=2e-3)


def test_wheels_droop_in_the_air_and_touch_before_a_point_would(fallen: TestRecord) -> None:
    measured = values(fallen)
    assert measured["contact.free_fall_time"] == pytest.approx(math.sqrt(2 * 0.5 / 9.81))
    assert measured["travel.droop"] < -0.05
    # not earlier than a car whose body has to fall what the wheels do not hang down, and the tyres are pressed in
    hang = 0.5 + measured["travel.droop"] - 0.05
    assert math.sqrt(2 * hang / 9.81) < measured["contact.time"] < measured["contact.free_fall_time"]
    assert measured["load.peak_ratio"] > 2.0
    assert measured["load.peak_chassis"] > 0.0
    assert 0.05 < measured["rebound.height"] < 0.5


def test_a_fall_too_short_to_settle_is_reported(prototype: TestedCar) -> None:
    record = perform(standard_test("drop"), prototype, {"duration": 1.0})
    error = next(m for m in record.measures if m.name == "rest.load_error")
    assert math.isnan(error.value)
    assert error.is_kept is False
    assert "longer duration" in error.note


def test_kerb_is_passed_both_ways(over_kerb: TestRecord) -> None:
    assert not over_kerb.notes
    assert len({m.text for m in over_kerb.measures}) == len(over_kerb.measures)
    measured = values(over_kerb)
    for direction, sign in (("down", -1.0), ("up", 1.0)):
        z = over_kerb.runs[direction]["chassis.z"]
        assert z[-1] - z[0] == pytest.approx(sign * 0.08, abs=2e-3)
        assert measured[f"{direction}.load.peak_ratio"] > 1.5
        # what is felt is less than what there is
        assert 0.0 < measured[f"{direction}.az.running_rms"] < measured[f"{direction}.az.peak"]
    # down, wheels hang; up, they are pushed in
    assert -measured["down.travel.droop"] > measured["down.travel.bump"]
    assert measured["up.travel.bump"] > -measured["up.travel.droop"]
    # at fidelity 0 there are no stresses, and none are told
    assert not any("stress" in name for name in measured)


@pytest.mark.slow
def test_results_do_not_depend_on_the_step(prototype: TestedCar, fallen: TestRecord, over_kerb: TestRecord) -> None:
    for record, test, worst in ((fallen, standard_test("drop"), 0.01), (over_kerb, standard_test("kerb"), 0.03)):
        coarse = values(perform(test, replace(prototype, step=0.005)))
        for name, fine in values(record).items():
            if "time" in name:
                assert coarse[name] == pytest.approx(fine, abs=0.006), name
            elif name != "rest.load_error":
                assert coarse[name] == pytest.approx(fine, rel=worst, abs=1e-6), name


def test_kerb_on_a_step_too_long_for_the_weighting(prototype: TestedCar) -> None:
    record = perform(standard_test("kerb"), replace(prototype, step=0.01), {"ahead": 2.0})
    rms = next(m for m in record.measures if m.name == "down.az.running_rms")
    assert math.isnan(rms.value)
    assert "0.005 s or less" in rms.note
    assert any("0.01 s" in note for note in record.notes)


@pytest.mark.slow
def test_a_kerb_that_is_not_reached_is_reported(prototype: TestedCar) -> None:
    # so slow that rolling resistance stops the car before the edge
    record = perform(standard_test("kerb"), prototype, {"speed": 4.0, "ahead": 7.5})
    assert any("not all wheels" in note for note in record.notes)
