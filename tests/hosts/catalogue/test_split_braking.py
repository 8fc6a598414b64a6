"""Braking on split friction: a synthetic stop with known measures, and the prototype, which turns to the high side."""

import math

import numpy as np
import pytest

from hosts.catalogue.car import TestedCar
from hosts.catalogue.execution import perform
from hosts.catalogue.registry import standard_test
from hosts.driving.result import Result
from tests.hosts.catalogue.measured import sheet_of, values


@pytest.mark.parametrize("heading", [0.0, 2.0])
def test_measures_of_a_made_stop(heading: float) -> None:
    onset, time = 1.0, 0.005 * np.arange(701)
    since = np.maximum(time - onset, 0.0)
    along, aside = 20.0 * time - 2.0 * since**2, 0.1 * since**2
    columns = {
        "speed": 20.0 - 4.0 * since,
        "chassis.x": math.cos(heading) * along - math.sin(heading) * aside,
        "chassis.y": math.sin(heading) * along + math.cos(heading) * aside,
        "chassis.yaw": heading + 0.15 * since**2,
        "chassis.wz": 0.3 * since,
        "sideslip": -0.1 * since**2,
        **{f"wheel_{w}.slip": np.where((time > 2.0) & (w[1] == "R"), -1.0, 0.0) for w in ("FL", "FR", "RL", "RR")},
    }
    run = Result(list(columns), {}, time, np.column_stack(list(columns.values())), 0.0, 3.5, 0, [])
    sheet = sheet_of("split_braking")
    sheet.add("stop", run=run, onset=onset)
    found = values(sheet.record())
    assert not sheet.notes
    assert found["deceleration.mean"] == pytest.approx(4.0)
    assert [found[f"yaw_rate.at_{t}_s"] for t in (1, 2)] == pytest.approx([0.3, 0.6])
    assert [found[f"yaw_angle.at_{t}_s"] for t in (1, 2)] == pytest.approx([0.15, 0.6])
    assert [found[f"deviation.at_{t}_s"] for t in (1, 2)] == pytest.approx([0.1, 0.4])
    assert [found[f"speed_lost.at_{t}_s"] for t in (1, 2)] == pytest.approx([4.0, 8.0])
    assert (found["yaw_rate.largest"], found["yaw_rate.largest_time"]) == pytest.approx((0.75, 2.5))
    assert found["sideslip.largest"] == pytest.approx(0.1 * 2.5**2)
    assert found["locked_time.FR"] == pytest.approx(1.5)
    assert found["locked_time.FL"] == 0.0


def test_a_stop_that_does_not_begin_or_locks_no_wheel_is_reported() -> None:
    names = ["speed", *(f"wheel_{w}.slip" for w in ("FL", "FR", "RL", "RR"))]
    run = Result(names, {}, np.arange(3.0), np.zeros((3, 5)), 0.0, 2.0, 0, [])
    sheet = sheet_of("split_braking")
    sheet.add("stop", run=run, onset=math.nan)
    assert all(m.is_missing and m.note for m in sheet.measures)
    sheet.add("stop", run=run, onset=0.5)
    assert "No wheel on the low friction locks at a pedal of 0.3" in sheet.notes[0]


def test_prototype_turns_to_the_side_of_the_high_friction(prototype: TestedCar) -> None:
    record = perform(standard_test("split_braking"), prototype)
    actual, run = values(record), record.runs["split_braking"]
    assert actual["yaw_rate.at_1_s"] > 0.1
    assert actual["deviation.at_1_s"] > 0.1
    assert min(actual["locked_time.FR"], actual["locked_time.RR"]) > max(
        actual["locked_time.FL"], actual["locked_time.RL"]
    )
    onset = run.time[np.argmax(run["brake"] > 0.0)]
    part = (run.time >= onset) & (run.time <= onset + 1.0)
    turned = np.trapezoid(run["chassis.wz"][part], run.time[part])
    assert actual["yaw_angle.at_1_s"] == pytest.approx(turned, rel=0.02)
