"""Slopes of regression lines."""

import math

import numpy as np
import pytest

from hosts.measures.library import gradient


def test_a_line_is_found_however_dense_its_points_are() -> None:
    """A curve whose points crowd at its begin has the slope of its chord's regression, not of its begin."""
    x = 5.0 * np.linspace(0.0, 1.0, 4000) ** 4
    assert gradient(x, 2.0 - 3.0 * x, 1.0, 4.0).slope == pytest.approx(-3.0)
    assert gradient(x, 2.0 - 3.0 * x, 1.0, 4.0).intercept == pytest.approx(2.0)
    assert gradient(x, x**2, 1.0, 4.0).slope == pytest.approx(5.0, rel=0.01)


def test_noise_shows_in_the_error() -> None:
    rng = np.random.default_rng(1)
    x = np.linspace(0.0, 5.0, 3000)
    line = gradient(x, 0.5 * x + rng.normal(0.0, 0.1, len(x)), 1.0, 4.0)
    assert abs(line.slope - 0.5) < 4.0 * line.error
    assert 0.0 < line.error < 0.01


def test_points_that_do_not_span_the_range_give_no_line() -> None:
    x = np.linspace(0.0, 2.5, 100)
    assert math.isnan(gradient(x, x, 1.0, 4.0).slope)
    assert math.isnan(gradient(np.array([1.0, 4.0]), np.array([1.0, 4.0]), 1.0, 4.0).slope)
    assert math.isnan(gradient(x, np.full(100, math.nan), 0.0, 2.0).slope)
