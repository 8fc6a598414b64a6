"""Circle, distance from it and the yaw rate that keeps it."""

import numpy as np
import pytest

from hosts.measures.disturbed_turn import circle_through, off_circle, yaw_rate_on_circle


@pytest.mark.parametrize("radius", [5.0, 100.0, 1000.0])
def test_circle_through_an_arc_far_from_the_origin(radius: float) -> None:
    angle = np.linspace(0.3, 0.3 + 20.0 / radius, 200)
    x, y = 500.0 + radius * np.cos(angle), -300.0 + radius * np.sin(angle)
    assert circle_through(x, y) == pytest.approx((500.0, -300.0, radius), rel=1e-6)


def test_outside_is_positive() -> None:
    circle = (1.0, 2.0, 10.0)
    np.testing.assert_allclose(off_circle(np.array([13.0, 1.0]), np.array([2.0, 9.0]), circle), [2.0, -3.0])


def test_yaw_rate_keeps_the_circle() -> None:
    np.testing.assert_allclose(yaw_rate_on_circle(np.array([20.0, 10.0]), -100.0), [-0.2, -0.1])
