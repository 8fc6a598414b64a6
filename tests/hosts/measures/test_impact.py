"""Measures of a fall against a mass on a spring and a damper, in closed form."""

import math

import numpy as np
import pytest

from hosts.measures.impact import fall_time, first_contact, rebound, settling_time, weight_from_momentum

M = 600.0  # kg
G = 9.81  # m/s2


def bounce(step: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Time, load and height of a mass that falls 0.2 m onto a spring with a damper, and stays on it."""
    k, ratio = 60_000.0, 0.6
    w, fall = math.sqrt(k / M), fall_time(0.2, G)
    wd, v = w * math.sqrt(1 - ratio**2), G * fall
    time = step * np.arange(round(6.0 / step) + 1)
    t = np.maximum(time - fall, 0.0)
    rest = -M * G / k
    decay = np.exp(-ratio * w * t)
    # z - rest = decay (A cos + B sin), z(0) = 0, z'(0) = -v
    a, b = -rest, (-v - ratio * w * rest) / wd
    z = rest + decay * (a * np.cos(wd * t) + b * np.sin(wd * t))
    speed = decay * ((b * wd - ratio * w * a) * np.cos(wd * t) - (a * wd + ratio * w * b) * np.sin(wd * t))
    load = np.where(time < fall, 0.0, -k * z - 2 * ratio * w * M * speed)
    height = np.where(time < fall, 0.2 - 0.5 * G * time**2, z)
    return time, load, height


@pytest.mark.parametrize(("step", "accuracy"), [(0.001, 3e-4), (0.005, 3e-3)])
def test_weight_from_momentum(step: float, accuracy: float) -> None:
    # at the contact the load steps by the damper's force, of which a sample sees half a step too much or too little
    time, load, _ = bounce(step)
    assert weight_from_momentum(time, load) == pytest.approx(M * G, rel=accuracy)


def test_contact_is_where_free_fall_ends() -> None:
    time, load, _ = bounce(0.002)
    fall = fall_time(0.2, G)
    assert fall == pytest.approx(math.sqrt(2 * 0.2 / 9.81), rel=1e-12)
    assert 0.0 <= first_contact(time, load) - fall <= 0.002
    assert math.isnan(first_contact(time, 0.0 * load))


def test_lowest_and_highest_after_contact() -> None:
    time, load, height = bounce(0.001)
    after = time >= first_contact(time, load)
    lowest, highest = rebound(height[after])
    assert height[after][lowest] == height[after].min()
    assert height[after][highest] == height[after][lowest:].max()
    assert height[after][highest] > -M * G / 60_000.0
    # a body that only sinks has no rebound
    assert rebound(np.array([3.0, 2.0, 1.0])) == (2, 2)


def test_settling_time_of_a_decaying_oscillation() -> None:
    time = np.linspace(0.0, 10.0, 10_001)
    decay = np.exp(-time) * np.cos(30.0 * time)
    settled = settling_time(time, 5.0 + decay, 5.0, 0.05)
    assert math.log(1 / 0.05) - math.pi / 30 <= settled <= math.log(1 / 0.05)
    assert settling_time(time, np.full_like(time, 5.0), 5.0, 0.05) == 0.0
    assert math.isnan(settling_time(time, time, 0.0, 0.05))
