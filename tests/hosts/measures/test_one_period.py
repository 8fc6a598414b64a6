"""One period of steering: known lags and ratios are recovered."""

import math

import numpy as np
import pytest

from hosts.measures.one_period import correlation_lag, measure_response

PERIOD = 2.0
T = np.arange(0.0, 4.0, 0.005)


def wave(t: np.ndarray) -> np.ndarray:
    return np.where((t >= 0.0) & (t <= PERIOD), np.sin(2 * np.pi * t / PERIOD), 0.0)


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("lag", [0.0, 0.1234, 0.3])
def test_a_pure_delay(side: float, lag: float) -> None:
    actual = measure_response(T, side * 0.4 * wave(T), side * 3.0 * wave(T - lag), 0.9)
    assert actual.correlation_lag == pytest.approx(lag, abs=1e-3)
    assert actual.correlation == pytest.approx(1.0, abs=1e-3)
    assert (actual.first_lag, actual.second_lag) == pytest.approx((lag, lag), abs=1e-3)
    assert (actual.first_ratio, actual.second_ratio) == pytest.approx((7.5, 7.5), rel=1e-4)


def test_peaks_that_differ_are_distinguished() -> None:
    late = np.where(T < 1.1, wave(T - 0.1), 1.2 * wave(T - 0.1))
    actual = measure_response(T, wave(T), 2.0 * late, 0.9)
    assert actual.first_ratio == pytest.approx(2.0, rel=1e-4)
    assert actual.second_ratio == pytest.approx(2.4, rel=1e-4)


@pytest.mark.parametrize("phase", [0.1, 0.5, 1.0])
def test_hysteresis_of_a_steady_sine_is_the_sine_of_its_lag(phase: float) -> None:
    t = np.linspace(0.0, PERIOD, 4001)
    x = 2 * np.pi * t / PERIOD
    response = measure_response(t, 0.3 * np.sin(x), 5.0 * np.sin(x - phase), 0.9)
    assert response.hysteresis == pytest.approx(math.sin(phase), rel=1e-4)


def test_an_answer_before_its_cause_has_a_negative_lag() -> None:
    assert correlation_lag(wave(T - 0.5), wave(T - 0.3), 0.005, 0.9)[0] == pytest.approx(-0.2, abs=1e-3)


def test_a_signal_that_is_missing_yields_nothing() -> None:
    assert math.isnan(measure_response(T, wave(T), np.full_like(T, np.nan), 0.9).correlation_lag)
    assert math.isnan(measure_response(T, wave(T), np.zeros_like(T), 0.9).hysteresis)
