"""Clearance of an outline from cones against distances worked out by hand."""

import math

import numpy as np
import pytest

from ali3.iso_3888 import Gate
from hosts.driving.course import Course
from hosts.measures.clearance import clearance, outline

# one lane from 0 to 10 m, 4 m wide; a car of 4 m by 2 m
LANE = Course("lane", (Gate(0.0, 10.0, -2.0, 2.0),))


def least(x: float, y: float, yaw: float) -> float:
    return float(clearance(LANE, *(np.array([v]) for v in (x, y, yaw)), 4.0, 2.0)[0])


def test_outline_is_the_turned_rectangle() -> None:
    corners = outline(np.array([1.0]), np.array([2.0]), np.array([math.pi / 2]), 4.0, 2.0)[0]
    np.testing.assert_allclose(corners, [[0.0, 4.0], [0.0, 0.0], [2.0, 0.0], [2.0, 4.0]], atol=1e-12)


def test_between_lanes_nothing_is_near() -> None:
    assert least(-3.0, 0.0, 0.0) == math.inf
    assert least(20.0, 5.0, 0.3) == math.inf


def test_a_turned_car_meets_the_edge_with_its_corner() -> None:
    yaw = 0.2
    corner = 2.0 * math.sin(yaw) + 1.0 * math.cos(yaw)
    assert least(5.0, 0.0, yaw) == pytest.approx(2.0 - corner)


def test_a_cone_at_the_end_meets_the_side_between_the_corners() -> None:
    # the last cone on the left lies beside the middle of the car, both front and rear of which are outside the lane
    yaw = math.pi / 4
    x, y = 10.0 + 0.5, 2.0 - 1.1
    dx, dy = 10.0 - x, 2.0 - y
    aside = abs(math.cos(yaw) * dy - math.sin(yaw) * dx) - 1.0
    assert least(x, y, yaw) == pytest.approx(min(aside, 2.0 - y + 99.0), abs=1e-9)
    # half a metre further to the left it is hit
    assert least(x, y + 0.7, yaw) < 0.0


def test_the_wrong_side_is_a_hit() -> None:
    assert least(5.0, 8.0, 0.0) < -5.0
