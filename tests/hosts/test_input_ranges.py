"""Columns in another unit than the FMU's input are reported with the row and the probable unit."""

import math

import numpy as np
import pytest

from hosts.fmu.input_ranges import beyond_range
from hosts.fmu.variables import Variable

WAVE = np.sin(np.linspace(0.0, 6.0, 61))


def variable(unit: str, low: float, high: float) -> Variable:
    return Variable("u", "", "input", "continuous", "Real", unit, 0.0, low, high, None, {}, {})


@pytest.mark.parametrize(
    ("unit", "low", "high", "values", "message"),
    [
        ("1", -1.0, 1.0, 45.0 * WAVE, "% or deg"),
        ("rad", -0.6, 0.6, 20.0 * WAVE, "deg"),
        ("m", -0.1, 0.1, 60.0 * WAVE, "mm"),
        ("m/s", 0.0, 70.0, 120.0 + 60.0 * WAVE, "km/h"),
        ("1", -1.0, 1.0, 1.08 * WAVE, "it may be clipped"),
        ("1", 0.0, 1.0, -20.0 * np.abs(WAVE), "is its unit right"),
        ("N", -1000.0, 1000.0, 3e5 * WAVE, "is its unit right"),
        ("1", 0.0, math.inf, -1.0 - WAVE, "range"),
    ],
)
def test_another_unit_is_reported_with_its_row(unit, low, high, values, message):
    sentence = beyond_range(variable(unit, low, high), values)
    worst = int(np.argmax(np.maximum(low - values, values - high)))
    assert message in sentence
    assert f"in row {worst + 1} " in sentence
    assert f"{values[worst]:.6g}" in sentence


def test_rounding_is_not_outside_of_the_range():
    one = variable("1", -1.0, 1.0)
    assert beyond_range(one, np.array([-1.0 - 1e-6, 1.0 + 1e-6])) == ""
    assert beyond_range(one, np.array([0.0, 1.0 + 1e-5])) != ""
    assert beyond_range(variable("N", -math.inf, math.inf), 1e12 * WAVE) == ""
