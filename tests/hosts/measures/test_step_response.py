"""Measures of a step response against the closed form of a system of second order."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from hosts.measures.step_response import reference_time, step_response

BEFORE = (-0.9, -0.05)  # s
STEADY = (9.0, 10.0)  # s
T = np.arange(-1.0, 10.0 + 1e-9, 0.005)


def second_order(t: float | np.ndarray, w: float, zeta: float) -> np.ndarray:
    """Answer to a unit step at 0."""
    after = np.maximum(t, 0.0)
    wd = w * math.sqrt(1.0 - zeta**2)
    swing = np.cos(wd * after) + zeta / math.sqrt(1.0 - zeta**2) * np.sin(wd * after)
    return np.where(np.asarray(t) > 0.0, 1.0 - np.exp(-zeta * w * after) * swing, 0.0)


@pytest.mark.parametrize("zeta", [0.3, 0.5, 0.7])
@pytest.mark.parametrize("size", [1.0, -3.5])
def test_times_and_overshoot_are_those_of_the_closed_form(zeta: float, size: float) -> None:
    w = 6.0
    # an offset, as a sensor may have it, must not count
    actual = step_response(T, 0.2 + size * second_order(T, w, zeta), 0.0, BEFORE, STEADY)
    assert actual.steady == pytest.approx(size, rel=1e-6)
    assert actual.overshoot == pytest.approx(math.exp(-math.pi * zeta / math.sqrt(1 - zeta**2)), rel=1e-4)
    assert actual.peak_response_time == pytest.approx(math.pi / (w * math.sqrt(1 - zeta**2)), abs=1e-4)
    assert actual.peak == pytest.approx(size * (1.0 + actual.overshoot))
    exact = brentq(lambda t: float(second_order(t, w, zeta)) - 0.9, 1e-3, 0.6)
    assert actual.response_time == pytest.approx(exact, abs=1e-4)
    assert actual.unsteadiness < 1e-6


def test_a_response_of_first_order_has_no_peak() -> None:
    actual = step_response(T, 1.0 - np.exp(-np.maximum(T, 0.0) / 0.3), 0.0, BEFORE, STEADY)
    assert actual.response_time == pytest.approx(0.3 * math.log(10.0), abs=1e-4)
    assert actual.overshoot == 0.0
    assert math.isnan(actual.peak_response_time)


def test_the_reference_is_half_of_the_steering() -> None:
    ramp = 0.1 - 0.8 * np.clip(T / 0.2, 0.0, 1.0)
    assert reference_time(T, ramp, BEFORE, STEADY) == pytest.approx(0.1, abs=1e-9)
    assert math.isnan(reference_time(T, np.zeros_like(T), BEFORE, STEADY))


def test_a_record_that_ends_early_or_is_not_finite_yields_nothing() -> None:
    values = second_order(T, 6.0, 0.5)
    assert math.isnan(step_response(T[:500], values[:500], 0.0, BEFORE, STEADY).steady)
    assert math.isnan(step_response(T, np.full_like(T, np.nan), 0.0, BEFORE, STEADY).steady)
    assert math.isnan(step_response(T, np.zeros_like(T), 0.0, BEFORE, STEADY).response_time)
