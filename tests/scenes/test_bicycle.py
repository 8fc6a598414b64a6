"""The rigid bicycle with rolling wheels as velocity rows outside the kernel: published speeds and eigenvalues."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.rolling import RollingBicycle
from mbs.scenes import bicycle

WEAVE, CAPSIZE = 4.29238253634111, 6.02426201538837  # m/s, published: self-stable between them
AT_FIVE = (-14.07838969, -0.77534188 + 4.46486771j, -0.77534188 - 4.46486771j, -0.32286643)  # 1/s, at 5 m/s, published
DIFFERENCES = 1e-5  # of the central differences


@pytest.fixture(scope="module")
def rolling():
    return RollingBicycle()


def test_the_wheels_roll_without_slip_when_it_runs_straight(rolling):
    q, qd = rolling.state(5.0, 0.0, 0.0, 0.0, 0.0)
    np.testing.assert_allclose(rolling.contact_rows(q) @ qd, 0.0, atol=1e-12)
    moved = rolling.forms["front wheel", "centre"]
    np.testing.assert_allclose([g @ qd for g, _ in moved], (5.0, 0.0, 0.0), atol=1e-11)
    assert rolling.spins["front wheel"] @ qd == pytest.approx(5.0 / bicycle.FRONT_RADIUS)
    np.testing.assert_allclose(rolling.accelerations(q, qd), 0.0, atol=1e-8)


def test_it_is_stable_by_itself_between_the_published_speeds(rolling):
    np.testing.assert_allclose(rolling.stable_speeds(), (WEAVE, CAPSIZE), rtol=DIFFERENCES)


def test_the_eigenvalues_at_five_metres_a_second_are_the_published_ones(rolling):
    found = sorted(np.linalg.eigvals(rolling.matrix(5.0)), key=lambda v: (v.real, -v.imag))
    np.testing.assert_allclose(found, AT_FIVE, atol=DIFFERENCES)


def test_at_rest_it_falls_over(rolling):
    assert rolling.growth(0.0, oscillating=False) > 1.0
