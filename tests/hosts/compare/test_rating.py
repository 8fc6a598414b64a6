"""Errors against NumPy, the rating against its properties and an independent program."""

import math

import numpy as np
import pytest

from hosts.compare.deviations import deviations
from hosts.compare.rating import rating, resampled_evenly

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


def test_like_an_independent_program() -> None:
    """Values of objective-rating-metrics 1.3 (TU Graz), which follows ISO/TS 18571, for these signals."""
    y, x = np.sin(9.0 * T), 1.1 * np.sin(9.0 * (T - 0.02))
    actual = rating(y, x)
    assert actual.corridor == pytest.approx(0.6696063537309731, rel=1e-12)
    assert actual.phase == pytest.approx(0.9, rel=1e-12)
    assert actual.magnitude == pytest.approx(0.9502108470849571, rel=1e-12)
    assert actual.slope == pytest.approx(0.9500064356170399, rel=1e-12)
    assert actual.overall == pytest.approx(0.8278859980327884, rel=1e-12)
    assert actual.grade == "good"


def test_no_more_points_than_a_thousand() -> None:
    t = np.linspace(0.0, 10.0, 5001)
    grid, (y,) = resampled_evenly(t, 2.0 * t)
    assert len(grid) == 1000
    assert y == pytest.approx(2.0 * grid)
