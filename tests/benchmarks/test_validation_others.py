"""Published tests: tyres on the rig, acceleration times from rest, the table of the page."""

from pathlib import Path

import numpy as np
import pytest

from benchmarks.shared.pages import DOCS, table
from benchmarks.validation import __main__ as command
from benchmarks.validation import acceleration, avoidance, published_tests, tyre_rig
from benchmarks.validation.published_figures import Published
from mbs.tyre_files.fit_tmeasy import tmeasy_of_magic


@pytest.mark.parametrize(("angle", "slip"), [(8.0, 0.0), (-3.0, 0.0), (0.0, -5.0), (0.0, 5.0)])
def test_the_rig_returns_the_published_force_with_its_sign(angle: float, slip: float) -> None:
    lateral, load = slip == 0.0, 6000.0
    force = tyre_rig.published(
        tyre_rig.LATERAL if lateral else tyre_rig.LONGITUDINAL, lateral, load, angle if lateral else slip
    )
    actual = tyre_rig.rig_forces(tyre_rig.magic(), load, angle, slip)
    assert actual[lateral] == pytest.approx(force, rel=3e-4)
    assert np.sign(actual[lateral]) == np.sign(angle + slip)
    assert abs(actual[not lateral]) < 0.01 * abs(force)
    figure = Published("test", "N", {"formula": force}, tyre_rig.read_within(lateral, load, angle if lateral else slip))
    assert figure.row(actual[lateral])["verdict"] == "within"
    assert figure.row(-actual[lateral])["verdict"] != "within"


def test_the_error_of_the_other_formula_is_that_of_its_fit() -> None:
    tyre, errors = tmeasy_of_magic(tyre_rig.magic())
    assert errors["moment"] == 0.0  # there is no trail to be fitted
    load, most = 6000.0, 5500.0
    for angle in tyre_rig.ANGLES:
        force = tyre_rig.published(tyre_rig.LATERAL, True, load, angle)
        off = abs(tyre_rig.rig_forces(tyre, load, angle)[1] - force)
        assert 0.0 < off < 1.1 * errors["lateral"] * most


def test_times_are_those_of_the_speeds_asked_for() -> None:
    time = np.arange(0.0, 30.0, 0.01)
    assert acceleration.reached(time, 2.5 * time, 90.0) == pytest.approx(10.0)
    with pytest.raises(ValueError, match=r"reaches 108\.0 km/h; 200 km/h were asked for"):
        acceleration.reached(time, np.minimum(2.5 * time, 30.0), 200.0)


def test_the_part_is_merged_and_the_rest_of_the_page_stays(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    before = (DOCS / "validation.md").read_text(encoding="utf-8")
    (tmp_path / "validation.md").write_text(before, encoding="utf-8")
    result = [Published("a test", "s", {"somebody": 1.0}, 0.05).row(1.2)]
    monkeypatch.setattr("benchmarks.shared.command.DOCS", tmp_path)
    monkeypatch.setattr(published_tests, "rows", lambda: result)
    assert command.main(["others", "--write"]) == 0
    after = (tmp_path / "validation.md").read_text(encoding="utf-8")
    begin, end = "<!-- begin others -->\n", "<!-- end others -->"
    assert after.split(begin)[1].split(end)[0] == table(result, published_tests.COLUMNS) + "\n"
    assert "| a test, s | 1 (somebody) | 0.05 | 1.2 | +14 % |" in after
    assert [part.split(begin)[0] if k == 0 else part for k, part in enumerate(after.split(end))] == [
        part.split(begin)[0] if k == 0 else part for k, part in enumerate(before.split(end))
    ]


@pytest.mark.slow
def test_the_hatchback_is_slower_than_people_in_a_named_car(monkeypatch: pytest.MonkeyPatch) -> None:
    """What fails stays in the table, whose speed is bisected to 1 km/h."""
    monkeypatch.setitem(avoidance.SETTINGS, "resolution", 10.0)
    ((figure, speed),) = avoidance.compared()
    assert 55.0 < speed < 70.0
    assert figure.row(speed)["verdict"].startswith("-")


@pytest.mark.slow
def test_the_rows_of_another_program_have_its_sources_and_fail_where_it_differs() -> None:
    actual = published_tests.by_commonroad()
    assert len(actual) == 18
    verdicts = [figure.row(value)["verdict"] for figure, value in actual]
    roll = [float(v.split()[0]) for (figure, _), v in zip(actual, verdicts, strict=True) if "roll" in figure.test]
    assert len(roll) == 3
    assert min(roll) > 4.0
    yaw = [v for (f, _), v in zip(actual, verdicts, strict=True) if "consistent: yaw" in f.test]
    assert all(abs(float(v.split()[0])) < 0.4 for v in yaw)


def test_a_missing_log_is_reported(capsys: pytest.CaptureFixture[str]) -> None:
    assert command.main(["drive"]) == 2
    assert "The log of the drive is given by --log FILE." in capsys.readouterr().err
