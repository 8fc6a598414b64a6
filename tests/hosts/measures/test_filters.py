"""Filters keep the pass band in amplitude and phase."""

import numpy as np
import pytest

from hosts.measures.filters import crossing, interpolated_peak, phaseless_low_pass, resample


@pytest.mark.parametrize(("frequency", "part"), [(1.0, 1.0), (6.0, 0.5), (9.0, 1.0 / (1.0 + 1.5**12))])
def test_low_pass_leaves_the_square_of_a_butterworth_without_a_shift(frequency: float, part: float) -> None:
    t = np.arange(0.0, 20.0, 1e-3)
    wave = np.sin(2 * np.pi * frequency * t)
    result = phaseless_low_pass(wave, 1e-3, 6.0)
    inner = slice(5000, 15000)
    assert result[inner] == pytest.approx(part * wave[inner], abs=2e-4)


def test_low_pass_keeps_a_straight_line_to_its_ends() -> None:
    line = np.linspace(1.0, 3.0, 500)
    assert phaseless_low_pass(line, 0.01, 6.0) == pytest.approx(line, abs=2e-4)


def test_low_pass_of_a_short_signal_is_possible() -> None:
    assert len(phaseless_low_pass([1.0, 1.0, 1.0], 0.01, 6.0)) == 3


@pytest.mark.parametrize(
    ("interval", "poles", "message"), [(0.1, 12, "closer than 0.08"), (0.01, 7, "even number of poles")]
)
def test_an_impossible_low_pass_is_reported(interval: float, poles: int, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        phaseless_low_pass(np.zeros(100), interval, 6.0, poles)


def test_resampling_of_uneven_times_keeps_lines_and_ends() -> None:
    t = np.sort(np.append(np.random.default_rng(1).uniform(0.0, 2.0, 40), [0.0, 2.0]))
    even, values = resample(t, 3.0 * t - 1.0, 0.1)
    assert even == pytest.approx(0.1 * np.arange(21))
    assert values == pytest.approx(3.0 * even - 1.0)
    assert resample(t, t, 0.1, first=0.55)[0][0] == 0.55


@pytest.mark.parametrize(
    ("time", "values", "message"),
    [
        ([0.0], [1.0], "two samples"),
        ([0.0, 0.0], [1.0, 2.0], "increasing"),
        ([0.0, 1.0], [1.0, np.nan], "finite at 1 s"),
    ],
)
def test_a_wrong_signal_is_reported(time: list[float], values: list[float], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        resample(time, values, 0.1)


def test_crossings_are_found_between_samples_and_after_a_time() -> None:
    t = np.linspace(0.0, 10.0, 1001)
    wave = np.sin(t)
    assert crossing(t, wave, 0.5) == pytest.approx(np.pi / 6, abs=1e-5)
    assert crossing(t, wave, 0.0, after=1.0) == pytest.approx(np.pi, abs=1e-5)
    assert np.isnan(crossing(t, wave, 2.0))


def test_the_top_of_a_wave_is_found_between_samples() -> None:
    t = np.arange(0.0, 3.0, 0.1)
    assert interpolated_peak(t, np.sin(t)) == pytest.approx((np.pi / 2, 1.0), abs=2e-4)
