"""Errors against NumPy, the rating against its properties and an independent program."""

import math

import numpy as np
import pytest

from hosts.compare.deviations import deviations
from hosts.compare.rating import Rating, on_equal_steps, rating

T = np.linspace(0.0, 1.0, 500)


def test_deviations_are_those_of_numpy() -> None:
    rng = np.random.default_rng(1)
    y, x = rng.normal(size=T.size), rng.normal(size=T.size)
    found = deviations(T, y, x)
    assert found.rms == pytest.approx(np.sqrt(((x - y) ** 2).mean()), rel=1e-12)
    assert found.normalised == pytest.approx(found.rms / y.std(), rel=1e-12)
    assert found.mean == pytest.approx(x.mean() - y.mean(), rel=1e-9)
    assert found.correlation == pytest.approx(np.corrcoef(x, y)[0, 1], rel=1e-12)
    k = np.abs(x - y).argmax()
    assert (found.largest, found.time_of_largest) == (x[k] - y[k], T[k])


def test_signs_and_closed_forms_of_a_sine() -> None:
    t = np.arange(0.0, 10.0, 0.001)
    y = np.sin(2.0 * np.pi * t)
    late = deviations(t, y, np.sin(2.0 * np.pi * (t - 0.125)))
    assert late.correlation == pytest.approx(math.cos(math.pi / 4.0), abs=1e-6)
    assert late.rms == pytest.approx(math.sqrt(2.0) * math.sin(math.pi / 8.0), abs=1e-6)
    assert deviations(t, y, y + 0.5).mean == pytest.approx(0.5)  # simulated minus measured
    assert deviations(t, y, y - 0.5).largest == pytest.approx(-0.5)


def test_constant_signals_have_no_correlation_and_say_so() -> None:
    assert math.isnan(deviations(T, 0.0 * T + 2.0, T).correlation)
    assert "measured signal is constant" in deviations(T, 0.0 * T + 2.0, T).note
    assert "simulated signal is constant" in deviations(T, T, 0.0 * T).note
    assert math.isnan(rating(0.0 * T, T).overall)


def test_rounding_errors_of_a_straight_drive_are_constant() -> None:
    rounding = 1e-11 * np.sin(40.0 * T)
    found = deviations(T, rounding, 0.5 * rounding)
    assert "the measured and the simulated signal is constant" in found.note
    assert math.isnan(found.correlation)
    assert math.isnan(rating(rounding, -rounding).overall)
    assert deviations(T, 1e3 * rounding, 2e3 * rounding).correlation == pytest.approx(1.0)


def test_equal_signals_have_one_everywhere() -> None:
    y = np.sin(9.0 * T)
    assert rating(y, y) == Rating(1.0, 1.0, 1.0, 1.0, 1.0)
    assert rating(y, y).grade == "excellent"
    assert rating(y, -y).overall < 0.3


@pytest.mark.parametrize("shift", [-50, -20, 0, 30, 80])
def test_a_known_shift_gives_the_phase_score_of_its_length(shift: int) -> None:
    # A pulse of its own shape: the score falls from 1 to 0 over a fifth of the length.
    k = np.arange(500)
    y = np.exp(-(((k - 250.0) / 40.0) ** 2))
    x = np.exp(-(((k - shift - 250.0) / 40.0) ** 2))
    assert rating(y, x).phase == pytest.approx(1.0 - abs(shift) / 100.0, abs=1e-12)
    assert rating(y, x).magnitude == pytest.approx(1.0, abs=1e-3)


def test_a_known_factor_gives_the_corridor_score_of_a_constant() -> None:
    y = np.where(np.arange(500) % 2, 1.0, -1.0)  # always as large as the largest
    x = 1.3 * y
    assert rating(y, x).corridor == pytest.approx(((0.5 - 0.3) / (0.5 - 0.05)) ** 2, rel=1e-12)


def test_a_known_factor_gives_the_slope_score() -> None:
    y = np.sin(9.0 * T)
    assert rating(y, 1.4 * y).slope == pytest.approx(1.0 - 0.4 / 2.0, rel=1e-9)


def test_like_an_independent_program() -> None:
    """Values of objective-rating-metrics 1.3 (TU Graz), which follows ISO/TS 18571, for these signals."""
    y, x = np.sin(9.0 * T), 1.1 * np.sin(9.0 * (T - 0.02))
    actual = rating(y, x)
    assert actual.corridor == pytest.approx(0.6696063537309731, rel=1e-12)
    assert actual.phase == pytest.approx(0.9, rel=1e-12)
    assert actual.magnitude == pytest.approx(0.9502108470849571, rel=1e-12)
    assert actual.slope == pytest.approx(0.9500064356170399, rel=1e-12)
    assert actual.overall == pytest.approx(0.8278859980327884, rel=1e-12)


def test_against_that_program_where_it_is_installed() -> None:
    other = pytest.importorskip("objective_rating_metrics.rating")
    rng = np.random.default_rng(5)
    y = np.cumsum(rng.normal(size=400)) / 10.0
    x = y + 0.2 * rng.normal(size=400)
    t = np.linspace(0.0, 1.0, 400)
    theirs = other.ISO18571(np.c_[t, y], np.c_[t, x], dt=t[1])
    assert rating(y, x).overall == pytest.approx(theirs.overall_rating(-1), rel=1e-12)


def test_no_more_points_than_a_thousand() -> None:
    t = np.linspace(0.0, 10.0, 5001)
    grid, (y,) = on_equal_steps(t, 2.0 * t)
    assert len(grid) == 1000
    assert y == pytest.approx(2.0 * grid)
