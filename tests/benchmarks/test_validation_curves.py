"""Understeer angle and sideslip over lateral acceleration, for known motions."""

import numpy as np
import pytest

from benchmarks.validation.curves import (
    MIN_SECONDS,
    acceleration_error,
    curves,
    lateral_acceleration,
    window_rows,
    within,
)
from benchmarks.validation.drive import Drive

L = 2.4  # m
V = 25.0  # m/s
GRADIENT = 0.004  # rad s2/m


@pytest.fixture(scope="module")
def drive() -> Drive:
    """Slow turns to both sides of a car with constant understeer, without sideslip velocity of its own."""
    time = np.arange(0.0, 275.005, 0.01)
    rate = 0.3 * np.sin(2.0 * np.pi * time / 60.0)
    return Drive(time, L * rate / V + GRADIENT * rate * V, np.full_like(time, V), -0.02 * rate * V, rate)


def test_understeer_and_sideslip_are_binned_over_the_measured_acceleration(drive: Drive) -> None:
    rows = window_rows(drive)
    actual = curves(drive, L, drive.vy[rows] + 0.1, 0.9 * drive.yaw_rate[rows])
    judged = [c for c in actual if c.seconds >= MIN_SECONDS]
    assert {c.quantity for c in judged} == {"understeer angle", "sideslip"}
    assert min(c.acceleration for c in judged) < -0.5
    assert max(c.acceleration for c in judged) > 0.5
    for c in judged:
        ay = 9.81 * c.acceleration
        edge = 0.5 * 0.1 * 9.81
        if c.quantity == "sideslip":
            assert c.measured == pytest.approx(np.degrees(-0.02 * ay / V), abs=np.degrees(0.02 * edge / V))
            assert c.difference == pytest.approx(np.degrees(0.1 / V), abs=0.01)
        elif abs(c.acceleration) > 0.05:
            assert c.measured == pytest.approx(np.degrees(GRADIENT * abs(ay)), abs=np.degrees(GRADIENT * edge))
            # A tenth less yaw rate is a tenth of its angle L r / v more understeer, to the left as to the right.
            assert c.difference == pytest.approx(np.degrees(0.1 * L * abs(ay) / V**2), rel=0.3)
    # A second that lies in two windows counts once.
    assert sum(c.seconds for c in actual) / 2.0 == pytest.approx(80.0 + 35.0 - 2 * 0.5, abs=0.1)
    assert within(actual, "sideslip", 0.3) == (len(judged) // 2, len(judged) // 2)
    assert within(actual, "sideslip", 0.1)[0] == 0


def test_the_deviation_of_the_lateral_acceleration(drive: Drive) -> None:
    rows = window_rows(drive)
    own = lateral_acceleration(drive.vx[rows], drive.vy[rows], drive.yaw_rate[rows], 0.01)
    np.testing.assert_allclose(own, V * drive.yaw_rate[rows], atol=0.05)
    assert acceleration_error(drive, drive.vy[rows], drive.yaw_rate[rows]) == 0.0
    assert acceleration_error(drive, drive.vy[rows], drive.yaw_rate[rows] + 0.02) == pytest.approx(0.02 * V, rel=1e-3)
