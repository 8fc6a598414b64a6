"""Numbers of sine with dwell from synthetic signals."""

import math

import numpy as np
import pytest

from hosts.measures.sine_with_dwell import G, angle_by_regression, measure_sine_with_dwell

T = np.arange(-1.0, 4.5, 0.005)
END = 1.0 / 0.7 + 0.5


def steering(amplitude: float) -> np.ndarray:
    """Sine of 0.7 Hz that rests at its second peak."""
    period = 1.0 / 0.7
    phase = np.where(0.75 * period > T, T, np.clip(T - 0.5, 0.75 * period, None))
    return np.where((T > 0.0) & (T < END), amplitude * np.sin(2 * np.pi * phase / period), 0.0)


def yaw_rate(left_over: float) -> np.ndarray:
    """First peak 0.5 to the left; second peak 0.8 to the right, of which a part is left after the completion."""
    fade = np.where(T > END, left_over, 1.0)
    return np.where(
        T < 0.75,
        0.5 * np.sin(np.pi * np.clip(T, 0, None) / 0.75),
        -0.8 * fade * np.sin(np.pi * np.clip(T - 0.75, 0, 0.5)),
    )


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("part", [0.1, 0.6, -0.2])
def test_yaw_rate_ratios_and_times(side: float, part: float) -> None:
    decay = np.where(T > END, part * np.exp(-(T - END - 1.0)), 1.0)
    rate = np.where(
        T < 0.75,
        0.5 * np.sin(np.pi * np.clip(T, 0, None) / 0.75),
        -0.8 * np.minimum(np.clip(T - 0.75, 0.0, 0.5) / 0.5, 1.0),
    )
    # one peak above the plateau, between the change of side and the completion
    rate = np.where(T > 0.75, rate - 0.2 * np.exp(-(((T - 1.3) / 0.05) ** 2)), rate)
    rate = np.where(T > END, -0.8 * decay, rate)
    actual = measure_sine_with_dwell(
        T, side * steering(1.5), side * rate, side * np.full_like(T, 4.0), side * 0.1 * np.clip(rate, -1.0, 1.0)
    )
    assert actual.beginning == pytest.approx(math.asin(math.radians(5.0) / 1.5) / (2 * np.pi * 0.7), abs=1e-4)
    assert actual.completion == pytest.approx(END, abs=4e-3)
    assert actual.yaw_rate_ratio_1_00 == pytest.approx(0.8 * part, abs=5e-3)
    assert actual.yaw_rate_ratio_1_75 == pytest.approx(0.8 * part * math.exp(-0.75), abs=5e-3)
    assert actual.sideslip == pytest.approx(0.1, abs=1e-3)


def test_displacement_is_the_double_integral_from_beginning_of_steer() -> None:
    actual = measure_sine_with_dwell(T, steering(1.0), yaw_rate(0.0), np.full_like(T, 3.2))
    assert actual.displacement == pytest.approx(0.5 * 3.2 * 1.07**2, rel=1e-6)
    # 6 t from the beginning: t³
    grows = 6.0 * (T - actual.beginning)
    assert measure_sine_with_dwell(T, steering(1.0), yaw_rate(0.0), grows).displacement == pytest.approx(
        1.07**3, rel=1e-3
    )


def test_a_short_record_gives_the_numbers_before_its_end() -> None:
    for end, known in ((0.5, 0), (1.5, 1), (END + 1.2, 2), (END + 1.8, 3)):
        n = int(np.searchsorted(T, end))
        result = measure_sine_with_dwell(T[:n], steering(1.0)[:n], yaw_rate(0.5)[:n], np.ones(n))
        shown = [
            math.isfinite(x) for x in (result.displacement, result.yaw_rate_ratio_1_00, result.yaw_rate_ratio_1_75)
        ]
        assert shown == [True] * known + [False] * (3 - known)


def test_no_steering_yields_nothing() -> None:
    assert math.isnan(measure_sine_with_dwell(T, np.zeros_like(T), np.zeros_like(T), np.zeros_like(T)).beginning)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_angle_at_0_3_g_is_that_of_the_line_between_the_bounds(side: float) -> None:
    angle = np.linspace(0.0, 1.0, 2001)
    # a bend below 0.1 g and one above 0.375 g must not count
    g = np.where(angle < 0.1, 0.1 * (angle / 0.1) ** 2, 0.1 + 0.5 * (angle - 0.1))
    g = np.where(g > 0.375, 0.375 + 0.1 * (g - 0.375), g)
    assert angle_by_regression(side * angle, side * g * G) == pytest.approx(0.5, rel=1e-6)


def test_a_ramp_that_does_not_reach_0_375_g_has_no_angle() -> None:
    assert math.isnan(angle_by_regression(np.linspace(0, 1, 100), 0.37 * G * np.linspace(0, 1, 100)))
