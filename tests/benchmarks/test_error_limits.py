"""Tables of the page on trust: the closed form of a period, and the rows of the tables."""

import pytest

from benchmarks.car import error_limits


@pytest.mark.parametrize("steps", error_limits.STEPS_IN_A_PERIOD)
def test_the_period_error_is_that_of_the_trapezoidal_rule(steps):
    """Its frequency is 2 atan(omega h / 2) / h: (omega h)^2 / 12 less, and no more than the next term of the series."""
    row = error_limits.frequency(steps)
    phase = 2.0 * 3.141592653589793 / steps
    assert row["frequency_error"] == pytest.approx(row["closed_form"], rel=0.2 * phase**2 + 1e-3)


def test_a_kerb_at_speed_is_right_with_divided_steps():
    row = error_limits.kerb(20.0)
    assert row["2 ms"] < row["10 ms"] < 0.02
