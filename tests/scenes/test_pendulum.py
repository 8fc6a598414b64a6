"""The planar pendulum (IFToMM benchmark A01): published positions, tension in closed form, order two."""

import numpy as np
import pytest
from scipy.special import ellipk

from mbs import compile, simulate
from mbs.scenes import pendulum

GRAVITY = 9.81  # m/s2
PUBLISHED = {1.0: (0.986292, -0.165011), 5.0: (-0.942305, -0.334754), 10.0: (-0.275087, -0.961419)}  # s: m


@pytest.fixture(scope="module")
def system():
    return compile(pendulum.build())


def test_published_positions(system):
    h = 0.00025
    trajectory = simulate(system, 10.0, h)
    for t, place in PUBLISHED.items():
        k = round(t / h)
        actual = trajectory["bob.position.x"][k], trajectory["bob.position.y"][k]
        np.testing.assert_allclose(actual, place, atol=2e-5)
    assert np.ptp(trajectory["energy.total"]) < 5e-5  # J, the benchmark's limit at a coarser step


def test_the_tension_is_three_times_the_weight_s_component_to_order_two(system):
    """From rest at the level of the pivot: m v^2/L = 2 m g (-y), so the rod carries 3 m g (-y/L)."""
    steps = np.array([0.01, 0.005, 0.0025, 0.00125])
    errors = []
    for h in steps:
        t = simulate(system, 3.0, h)
        errors.append(np.abs(t["rod.tension"] - 3.0 * GRAVITY * -t["bob.position.y"]).max())
        assert t["rod.tension"].max() == pytest.approx(3.0 * GRAVITY, rel=1e-3)
    assert errors[0] < 1e-3 * 3.0 * GRAVITY
    assert 1.9 < np.polyfit(np.log(steps), np.log(errors), 1)[0] < 2.2


@pytest.mark.parametrize("length", [0.5, 2.0])
def test_the_period_is_that_of_the_elliptic_integral(length):
    """From rest at 90 degrees: 4 sqrt(L/g) K(sin^2 45 deg)."""
    period = 4.0 * np.sqrt(length / GRAVITY) * ellipk(0.5)
    steps = 2000
    end = simulate(compile(pendulum.build(length, mass=3.0)), period, period / steps)
    assert end["bob.position.x"][steps] == pytest.approx(-length, abs=1e-4 * length)
    assert end["bob.position.x"][steps // 2] == pytest.approx(length, abs=1e-4 * length)
