"""Perturbed starts, seconds left out of a fit, and bounds of a fit, against closed forms."""

from pathlib import Path

import numpy as np
import pytest

from benchmarks.validation import margins, omitted_seconds, refit
from benchmarks.validation.drive import Drive
from benchmarks.validation.fitting import SCALES
from hosts.compare.segments import Segment
from hosts.driving.manoeuvre import Manoeuvre
from hosts.measures.signal import Signal

STEP = 0.01


def segment() -> Segment:
    time = np.array([0.0, 1.0])
    start = {"initial.speed": 20.0, "initial.lateral_speed": 0.5, "initial.yaw_rate": 0.3}
    speed = Signal("speed", "speed", "m/s", time, np.array([20.0, 24.0]))
    return Segment(Manoeuvre("drive", time, {"steering": 0.1 + 0.0 * time}, 1.0, start), speed)


def test_a_start_beside_the_state_is_that_of_the_reference_point() -> None:
    """The velocity of a rigid body at a point is that of the origin and the yaw rate times the lever."""
    point = -1.33, 0.02
    original, moved = (s.manoeuvre.start for s in (segment(), margins.with_offset(segment(), 0.5, -0.3, 0.024, point)))

    def at_point(start) -> list[float]:
        rate = start["initial.yaw_rate"]
        return [start["initial.speed"] - rate * point[1], start["initial.lateral_speed"] + rate * point[0], rate]

    np.testing.assert_allclose(np.subtract(at_point(moved), at_point(original)), [0.5, -0.3, 0.024], atol=1e-15)


def test_a_faster_stretch_holds_and_starts_with_more_speed_at_the_same_steering() -> None:
    faster = margins.with_speed(segment(), 1.1)
    assert faster.manoeuvre.start["initial.speed"] == pytest.approx(22.0)
    assert faster.speed is not None
    assert faster.speed.values.tolist() == pytest.approx([22.0, 26.4])
    assert faster.manoeuvre.inputs["steering"].tolist() == [0.1, 0.1]


def laps() -> Drive:
    """Laps of 2000 m with a corner to the left at 500 to 700 m and one to the right at 1200 to 1300 m."""
    time = np.arange(0.0, 230.0, STEP)
    vx = 30.0 + 5.0 * np.sin(0.17 * time)
    distance = STEP * np.concatenate([[0.0], np.cumsum(0.5 * (vx[1:] + vx[:-1]))])
    at = distance % 2000.0
    curvature = np.where((at > 500.0) & (at < 700.0), 0.01, np.where((at > 1200.0) & (at < 1300.0), -0.02, 0.0))
    return Drive(time, 0.0 * time, vx, 0.0 * time, curvature * vx)


def test_seconds_are_distinguished_by_corner_speed_and_acceleration() -> None:
    drive = laps()
    actual = omitted_seconds.families(drive)
    corners = actual["corners"]
    assert [name.startswith("corner at") for name in corners.names] == [True, True]
    left, right = (np.flatnonzero(drive.yaw_rate * side > 0.0) for side in (1.0, -1.0))
    for rows in (left, right):
        assert np.bincount(corners.number[rows], minlength=3).max() > 0.9 * len(rows)
    assert corners.number[left[50]] != corners.number[right[50]]
    assert corners.number[np.argmax(drive.yaw_rate == 0.0)] == 2
    speeds = np.bincount(actual["speed"].number)
    np.testing.assert_allclose(speeds, len(drive.time) / omitted_seconds.SPEEDS, rtol=0.01)
    assert np.bincount(actual["acceleration"].number, minlength=5)[2] == (np.abs(drive.ax) < 1.0).sum()


def test_a_kind_is_judged_by_what_the_others_lead_to() -> None:
    """A line through the others, which is exact for a linear model, and not through the kind."""
    random = np.random.default_rng(3)
    count = 400
    number = np.arange(count) % 4
    family = omitted_seconds.Family(["a", "b", "c"], number)  # the fourth is of no kind
    x = np.column_stack([random.normal(size=2 * count), np.ones(2 * count)])
    measured = random.normal(size=2 * count) + np.tile(number, 2)
    p = np.array([0.3, -0.2])
    row = omitted_seconds.without_kinds(x, x @ p - measured, np.arange(count), {"corners": family})
    sizes = []
    for k in range(3):
        others = np.tile(number, 2) != k
        q = np.linalg.lstsq(x[others], measured[others], None)[0]
        own = np.flatnonzero(number == k)
        sizes.append(SCALES[0] * np.sqrt(np.mean((x[own] @ q - measured[own]) ** 2)))
    assert row["corners, mean"] == pytest.approx(np.mean(sizes))
    assert row["corners, worst"] == pytest.approx(max(sizes))
    assert row["worst kind"] == "abc"[int(np.argmax(sizes))]


def test_the_bounds_of_a_fit_are_read_and_a_number_near_one_is_reported(tmp_path: Path) -> None:
    file = tmp_path / "fit.toml"
    file.write_text('["a.b"]\nlow = 1.0\nhigh = 2\n', encoding="utf-8")
    assert refit.read_ranges(file) == {"a.b": "1.0:2.0"}
    results = {"name": "a.b", "value": 1.5, "half_width_95": 0.1, "folds": [1.4, 1.6], "without": 1.02}
    rows = [refit.row_of(results | {"value": value}, 1.0, 2.0) for value in (1.015, 1.5, 1.985)]
    assert [row["near a bound"] for row in rows] == ["yes", "no", "yes"]
    assert [line.split()[0] for line in refit.bound_notes(rows)] == ["`a.b`", "`a.b`"]
    assert rows[1]["without it"] == pytest.approx(2.0)
