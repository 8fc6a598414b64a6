"""The circle follower with a car without slip, delayed steering and a wrong steering ratio."""

import math

import numpy as np
import pytest

from hosts.driving.pilots.circle_follower import CircleFollower


def drive(radius: float, yaw: float = 0.3, gain: float = 1.2, seconds: float = 30.0, step: float = 0.01) -> np.ndarray:
    """Distances from the circle's centre of a point at 12 m/s whose curvature follows the steering after 0.15 s."""
    pilot = CircleFollower(radius, 12.0, 2.5, 0.5)
    x, y, curvature, speed = 5.0, -3.0, 0.0, 11.0
    centre = (x - radius * math.sin(yaw), y + radius * math.cos(yaw))
    rows = []
    for k in range(round(seconds / step)):
        observation = {"chassis.x": x, "chassis.y": y, "chassis.yaw": yaw - 0.05, "sideslip": 0.05, "speed": speed}
        act = pilot.act(k * step, observation)
        rows.append((math.hypot(x - centre[0], y - centre[1]), pilot.offset(observation), speed))
        curvature += step / 0.15 * (gain * math.tan(0.5 * act["steering"]) / 2.5 - curvature)
        speed += step * (3.0 * act["throttle"] - 8.0 * act["brake"])
        yaw += step * speed * curvature
        x += step * speed * math.cos(yaw)
        y += step * speed * math.sin(yaw)
    return np.array(rows)


@pytest.mark.parametrize("radius", [40.0, -40.0, 100.0])
def test_circle_is_held_to_both_sides(radius: float) -> None:
    rows = drive(radius)
    assert np.abs(rows[:, 0] - abs(radius)).max() < 2.0
    assert rows[-1, 0] == pytest.approx(abs(radius), abs=0.01)
    assert rows[-1, 2] == pytest.approx(12.0, abs=0.1)


def test_offset_is_positive_to_the_left() -> None:
    for radius in (50.0, -50.0):
        pilot = CircleFollower(radius, 10.0, 2.5, 0.5)
        start = {"chassis.x": 0.0, "chassis.y": 0.0, "chassis.yaw": 0.0, "sideslip": 0.0, "speed": 10.0}
        assert pilot.offset(start) == 0.0
        pilot.act(0.0, start)
        assert pilot.offset(start | {"chassis.y": 0.2}) == pytest.approx(0.2)
        assert pilot.act(0.01, start | {"chassis.y": 2.0})["steering"] < pilot.act(0.02, start)["steering"]


def test_steering_stays_within_its_limits() -> None:
    pilot = CircleFollower(1.0, 10.0, 2.5, 0.5, "steering_wheel_angle_demand", 0.7)
    start = {"chassis.x": 0.0, "chassis.y": 0.0, "chassis.yaw": 0.0, "sideslip": 0.0, "speed": 10.0}
    assert pilot.act(0.0, start)["steering_wheel_angle_demand"] == 0.7
