"""The line of least curvature: inside the lanes, and its curvature against simpler lines and a lower bound."""

import numpy as np
import pytest

from ali3.iso_3888 import Gate
from hosts.common.errors import HostError
from hosts.driving.course import TRACKS, Course, course_of
from hosts.driving.planned_course import planned
from hosts.measures.clearance import clearance

LENGTH = 4.2  # m
WIDTH = 1.8  # m


def points(course: Course, x: np.ndarray) -> np.ndarray:
    return np.array([course.path(v) for v in x]).T


@pytest.mark.parametrize("name", list(TRACKS))
def test_line_keeps_its_room_and_bends_less_than_the_centre_line(name: str) -> None:
    course = course_of(name, WIDTH)
    line = planned(course, 0.0, LENGTH, WIDTH)
    x = np.linspace(0.0, course.gates[-1].x_end + 5.0, 2000)
    y, slope, bend = points(line, x)
    narrowest = min(g.y_left - g.y_right for g in course.gates) - WIDTH
    free = clearance(course, x, y, np.arctan(slope), LENGTH, WIDTH).min()
    # half of the room of each side is kept; slopes of up to 0.2 cost some centimetres of it
    assert 0.25 * narrowest - 0.04 < free < 0.5 * narrowest
    y, slope_of_centres, bend_of_centres = points(course, x)
    if clearance(course, x, y, np.arctan(slope_of_centres), LENGTH, WIDTH).min() > 0.0:
        assert np.abs(bend).max() < 0.7 * np.abs(bend_of_centres).max()
    else:
        assert name == "iso_3888_2"  # whose narrow lanes the line of centres does not keep
    assert line.path(0.0)[:2] == pytest.approx((course.gates[0].centre, 0.0), abs=1e-9)
    # slope and curvature are those of the line
    np.testing.assert_allclose(np.gradient(points(line, x)[0], x)[1:-1], slope[1:-1], atol=1e-4)


def test_one_lane_change_needs_the_curvature_of_two_arcs() -> None:
    # offset d within the length l by two parabolas: 4 d / l^2; the room of 1 cm lets the bends begin 2.5 m in the lanes
    far = 60.0
    course = Course("aside", (Gate(0.0, 40.0, -0.01, 0.01), Gate(40.0 + far, 200.0, 2.99, 3.01)))
    x = np.linspace(0.0, 150.0, 1501)
    bend = np.abs(points(planned(course, 0.0, 0.001, 0.001), x)[2]).max()
    assert 4 * 2.98 / (far + 6.0) ** 2 < bend < 1.2 * 4 * 3.0 / far**2


def test_a_car_too_wide_is_reported() -> None:
    course = course_of("iso_3888_2", 1.5)
    with pytest.raises(HostError, match=r"lane 1 is 1\.9 m wide; a car of 2\.1 m"):
        planned(course, 0.0, 4.0, 2.1)
