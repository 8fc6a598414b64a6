"""The throttle released on circles: closed forms of a synthetic turn, the prototype car, and refusals."""

import math

import pytest

from hosts.catalogue.execution import perform
from hosts.catalogue.measure_sheet import Sheet
from hosts.catalogue.registry import standard_test
from hosts.catalogue.standard.power_off_in_a_turn import add_releases, drive
from hosts.common.errors import HostError
from tests.hosts.catalogue.made_turn import turn
from tests.hosts.catalogue.measured import sheet_of, values

TEST = standard_test("power_off_in_a_turn")


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_measures_of_made_turns(side):
    """At 20 m/s on circles of 100 and 80 m; compared halfway between both lateral accelerations, 4 and 5 m/s2."""
    sheet = sheet_of("power_off_in_a_turn", compared_at=4.5)
    add_releases(sheet, [(4.0, turn(1.0, 1.1, side * 100.0, 0.2)), (5.0, turn(1.0, 1.3, side * 80.0, -0.4))])
    measured = {m.name: m.value for m in sheet.measures}
    assert measured["yaw_rate.ratio"] == pytest.approx(1.2, rel=1e-4)
    assert measured["worst.yaw_rate.ratio"] == pytest.approx(1.3, rel=1e-6)
    assert measured["yaw_rate.change"] == pytest.approx(0.5 * (0.1 * 19.0 / 100.0 + 0.3 * 19.0 / 80.0), rel=1e-4)
    assert measured["sideslip.change"] == pytest.approx(-0.05, rel=1e-3)
    assert measured["path.deviation"] == pytest.approx(-0.1, abs=1e-3)
    assert measured["worst.path.deviation"] == pytest.approx(-0.4, abs=1e-4)
    assert measured["ay.ratio"] == pytest.approx(1.0, rel=1e-6)
    assert measured["deceleration"] == pytest.approx(1.0, rel=1e-6)
    assert measured["ay.largest"] == pytest.approx(5.0, rel=1e-6)
    assert math.isnan(measured["spin.ay"])
    assert [note for note in sheet.notes if "asked for" not in note] == []


def test_each_release_has_a_run_of_its_own(monkeypatch):
    sheet = sheet_of("power_off_in_a_turn", lowest=10.0, highest=10.5, levels=12.0)
    monkeypatch.setattr("hosts.catalogue.standard.power_off_in_a_turn.drive_stop", lambda *_: turn(1.0, 1.0, 40.0, 0.0))
    monkeypatch.setattr(Sheet, "with_step_up_to", lambda *_: None)
    drive(sheet)
    assert len(sheet.runs) == 12


def test_a_lateral_acceleration_that_no_circle_has_is_reported():
    sheet = sheet_of("power_off_in_a_turn", compared_at=7.0)
    add_releases(sheet, [(6.0, turn(1.0, 1.0, 80.0, 0.0))])
    measured = {m.name: m for m in sheet.measures}
    assert math.isnan(measured["yaw_rate.ratio"].value)
    assert "5 to 5 m/s²" in measured["yaw_rate.ratio"].note
    assert measured["worst.yaw_rate.ratio"].value == pytest.approx(1.0)
    assert "80 m and 5 m/s² where 100 m and 6 m/s² were asked for" in sheet.notes[0]


@pytest.mark.slow
def test_prototype_without_power_turns_in_and_slows_down(prototype):
    record = perform(TEST, prototype, {"levels": 2.0, "lowest": 4.5, "highest": 5.5})
    measured = values(record)
    assert measured["ay.largest"] == pytest.approx(5.5, rel=0.02)
    assert 0.0 < measured["deceleration"] < 2.0
    assert measured["worst.path.deviation"] < 0.0  # load moves to the front wheels


def test_a_circle_that_cannot_be_held_is_reported(prototype):
    record = perform(TEST, prototype, {"levels": 1.0, "lowest": 14.0, "highest": 14.0, "radius": 60.0})
    assert record.notes
    assert "did not get onto" in record.notes[0] or "not steady" in record.notes[0]


@pytest.mark.parametrize(
    ("settings", "message"), [({"radius": 5.0}, "radius"), ({"levels": 2.5}, "levels"), ({"lowest": 9.0}, "lower one")]
)
def test_settings_that_make_no_sense_are_refused(prototype, settings, message):
    with pytest.raises(HostError, match=message):
        perform(TEST, prototype, settings)
