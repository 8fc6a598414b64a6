"""Lane observations of a car, against a circle and a straight."""

import numpy as np
import pytest

from hosts.common.errors import HostError
from hosts.driving.course import course_of
from hosts.plant import Lane

RADIUS = 40.0
TURN = np.linspace(0.0, 2.0 * np.pi, 241)
POINTS = RADIUS * np.column_stack([np.cos(TURN), np.sin(TURN)])
POINTS[-1] = POINTS[0]


def test_a_circle_to_the_left() -> None:
    lane = Lane(POINTS)
    assert lane.closed
    for angle in np.linspace(0.1, 15.0, 90):  # more than twice around
        for off, turned in ((1.2, 0.1), (-0.7, -0.3)):
            x, y = (RADIUS - off) * np.cos(angle), (RADIUS - off) * np.sin(angle)
            offset, heading, bend = lane.sense(x, y, angle + 0.5 * np.pi + turned, (0.0, 30.0))
            assert offset == pytest.approx(off, abs=1e-4)
            assert heading == pytest.approx(turned, abs=1e-4)
            assert bend == pytest.approx([1.0 / RADIUS] * 2, rel=1e-3)


def test_the_other_way_round_all_signs_turn() -> None:
    offset, heading, bend = Lane(POINTS[::-1]).sense(RADIUS + 1.0, 0.0, -0.5 * np.pi + 0.2)
    assert (offset, heading) == (pytest.approx(1.0, abs=1e-4), pytest.approx(0.2, abs=1e-4))
    assert (bend < 0.0).all()


def test_a_lane_that_crosses_itself_is_followed_along_its_way() -> None:
    s = np.linspace(0.0, 2.0 * np.pi, 400)
    eight = np.column_stack([200.0 * np.sin(s), 100.0 * np.sin(2.0 * s)])
    lane = Lane(eight)
    ways = []
    for x, y in eight[1:-1]:
        ways.append(lane.place(x, y))
    assert (np.diff(ways) > 0.0).all()


def test_a_course_of_cones_is_a_lane_along_its_path() -> None:
    course = course_of("iso_3888_1", 1.6)
    lane = Lane.of_course(course, 150.0)
    for x in np.linspace(1.0, 140.0, 40):
        y, slope, bend = course.path(float(x))
        offset, heading, curvature = lane.sense(x, y, float(np.arctan(slope)), (0.0,))
        assert abs(offset) < 1e-3
        assert abs(heading) < 2e-3
        assert curvature[0] == pytest.approx(bend, abs=1e-3)


def test_an_invalid_line_is_refused_in_one_sentence() -> None:
    for points, message in (
        (np.zeros((3, 2)), "shape"),
        (np.zeros((5, 2)), "lies on the one before"),
        ("road", "The points of a lane are 'road'; they must be numbers up to 1e.09 m"),
    ):
        with pytest.raises(HostError, match=message):
            Lane(points)
    for width in (0.0, np.nan, "wide"):
        with pytest.raises(HostError, match="width of a lane"):
            Lane(POINTS, width)
    lane = Lane(POINTS)
    lane.sense(0.0, RADIUS, 0.0)
    with pytest.raises(HostError, match="must be two finite numbers"):
        lane.sense(np.nan, RADIUS, 0.0)
    with pytest.raises(HostError, match="The heading on a lane is nan; it must be a finite number, in rad"):
        lane.sense(0.0, RADIUS, np.nan)
    with pytest.raises(HostError, match="The distances ahead are 'far'; they must be numbers"):
        lane.sense(0.0, RADIUS, 0.0, "far")
    assert lane.way == pytest.approx(0.25 * lane.length, abs=1e-3)
