"""Measures of braking against motions in closed form."""

import math

import numpy as np
import pytest

from hosts.measures.braking import (
    STANDING,
    corrected_to,
    distance_between,
    locked,
    mean_fully_developed_deceleration,
    stopping_distance,
    time_below,
    time_to_reach,
    travelled,
)

ONSET = 1.0  # s
V = 100.0 / 3.6  # m/s
A = 8.0  # m/s2


def stop(step: float, offset: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Time and speed of a car that brakes with a constant deceleration from `ONSET` on."""
    time = offset + step * np.arange(round(6.0 / step))
    return time, np.clip(V - A * (time - ONSET), 0.0, V)


@pytest.mark.parametrize(("step", "offset"), [(0.001, 0.0), (0.005, 0.0), (0.013, 0.0), (0.05, 0.0)])
def test_constant_deceleration(step: float, offset: float) -> None:
    time, speed = stop(step, offset)
    mean = mean_fully_developed_deceleration(time, speed, ONSET, V)
    assert mean == pytest.approx(A, rel=1e-9)
    # of the step in which braking begins the ramp is not known: v a h^2 / 2 at most
    assert stopping_distance(time, speed, ONSET, mean) == pytest.approx(V**2 / (2 * A), abs=A * step**2)


def test_formula_of_the_regulation_in_its_own_units() -> None:
    time = np.linspace(0.0, 8.0, 4001)
    speed = V * np.maximum(1.0 - time / 6.0, 0.0) ** 1.5
    distance = V * 6.0 / 2.5 * (1.0 - np.maximum(1.0 - time / 6.0, 0.0) ** 2.5)
    begin, end = (np.interp(-share * V, -speed[:3000], distance[:3000]) for share in (0.8, 0.1))
    regulation = ((0.8 * 100.0) ** 2 - (0.1 * 100.0) ** 2) / (25.92 * (end - begin))
    assert mean_fully_developed_deceleration(time, speed, 0.0, V) == pytest.approx(regulation, rel=1e-5)


def test_a_rise_of_the_deceleration_lengthens_the_way_but_not_the_mean() -> None:
    # linear rise within T: the speed is lower by A T / 2 than if it had begun at once, later by T / 2
    rise, time = 0.2, np.linspace(0.0, 5.0, 50_001)
    since = time - ONSET
    speed = V - A * np.where(since < 0, 0, np.where(since < rise, since**2 / (2 * rise), since - rise / 2))
    speed = np.maximum(speed, 0.0)
    mean = mean_fully_developed_deceleration(time, speed, ONSET, V)
    assert mean == pytest.approx(A, rel=1e-6)
    expected = V * rise / 2 + V**2 / (2 * A) - A * rise**2 / 24
    assert stopping_distance(time, speed, ONSET, mean) == pytest.approx(expected, abs=1e-4)
    deceleration = A * np.clip(since / rise, 0.0, 1.0)
    assert time_to_reach(time, deceleration, 0.9 * A, ONSET) == pytest.approx(0.9 * rise, abs=1e-9)


def test_correction_is_that_of_constant_deceleration() -> None:
    assert corrected_to(V, 26.0**2 / (2 * A), 26.0) == pytest.approx(V**2 / (2 * A), rel=1e-12)


def test_the_rest_below_standing_is_added() -> None:
    time, speed = stop(0.001)
    moving = speed > STANDING
    last = np.flatnonzero(moving)[-1] + 2
    assert stopping_distance(time[:last], speed[:last], ONSET, A) == pytest.approx(V**2 / (2 * A), abs=1e-5)


def test_what_does_not_come_is_not_a_number() -> None:
    time, speed = stop(0.01)
    early = time < 3.0
    assert math.isnan(mean_fully_developed_deceleration(time[early], speed[early], ONSET, V))
    assert math.isnan(stopping_distance(time[early], speed[early], ONSET, A))
    assert math.isnan(time_below(time[early], speed[early], 1.0, ONSET))
    assert math.isnan(distance_between(time, speed, 1.0, math.nan))
    # a car that gathers speed has no deceleration to end its way with
    assert math.isnan(stopping_distance(time, speed, ONSET, -1.0))


def test_speeds_before_the_onset_do_not_count() -> None:
    time = np.linspace(0.0, 4.0, 401)
    speed = np.where(time < 0.5, 0.0, 10.0)
    speed[time > 2.0] = 0.0
    assert time_below(time, speed, 5.0, after=1.0) == pytest.approx(2.005, abs=0.006)
    assert travelled(time, speed)[-1] == pytest.approx(15.1, abs=0.2)


def test_wheels_are_locked_above_the_slowest_speed_only() -> None:
    slip = np.array([[-0.1, -1.0], [-0.95, -0.5], [-1.0, -1.0]])
    expected = [[False, True], [True, False], [False, False]]
    assert locked(slip, np.array([10.0, 10.0, 2.0])).tolist() == expected
