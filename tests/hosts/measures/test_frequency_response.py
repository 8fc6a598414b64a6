"""Frequency responses against known systems."""

import math

import numpy as np
import pytest
from scipy.signal import TransferFunction, chirp, lsim
from scipy.signal.windows import tukey

from hosts.measures.frequency_response import FrequencyResponse, bandwidth, frequency_response
from hosts.measures.second_order import fit_second_order

W = 8.0  # rad/s
ZETA = 0.4
LEAD = 0.15  # s
INTERVAL = 0.01
F = np.geomspace(0.2, 4.0, 40)
T = np.arange(0.0, 64.0, INTERVAL)
SWEEP = np.append(
    chirp(T[:6000], 0.1, 60.0, 4.4, "logarithmic", phi=-90.0) * tukey(6000, 0.05), np.zeros(len(T) - 6000)
)


def exact(f: np.ndarray, gain: float = 2.5) -> np.ndarray:
    s = 2j * np.pi * f
    return gain * (1.0 + LEAD * s) / (1.0 + 2.0 * ZETA * s / W + (s / W) ** 2)


def answer(gain: float = 2.5) -> np.ndarray:
    system = TransferFunction([gain * LEAD, gain], [1.0 / W**2, 2.0 * ZETA / W, 1.0])
    return np.asarray(lsim(system, SWEEP, T)[1])


def of(response: np.ndarray, coherence: float = 1.0) -> FrequencyResponse:
    return FrequencyResponse(F, response, np.full(len(F), coherence))


def test_gain_and_phase_are_those_of_the_system() -> None:
    result = frequency_response(SWEEP, answer(), INTERVAL, F)
    error = result.response / exact(F) - 1.0
    assert np.abs(error).max() < 0.03
    assert np.sqrt(np.mean(np.abs(error) ** 2)) < 0.01
    assert result.coherence.min() > 0.995


def test_noise_lowers_the_coherence_but_does_not_bias_the_response() -> None:
    noisy = answer() + np.random.default_rng(3).normal(0.0, 1.0, len(T))
    result = frequency_response(SWEEP, noisy, INTERVAL, F)
    assert result.coherence.mean() < 0.98
    assert abs(np.mean(result.response / exact(F)) - 1.0) < 0.02


def test_noise_alone_has_no_coherence() -> None:
    rng = np.random.default_rng(5)
    result = frequency_response(SWEEP, rng.normal(0.0, 1.0, len(T)), INTERVAL, F[F > 1.0])
    assert result.coherence.mean() < 0.4


def test_the_fit_finds_the_system_of_second_order() -> None:
    fits = fit_second_order([of(exact(F)), of(exact(F, -0.3) / (1 + LEAD * 2j * np.pi * F))], [1, 0])
    for fit, gain in zip(fits, (2.5, -0.3), strict=True):
        assert fit.natural_frequency == pytest.approx(W, rel=1e-6)
        assert fit.damping_ratio == pytest.approx(ZETA, rel=1e-6)
        assert fit.gain == pytest.approx(gain, rel=1e-6)
        assert fit.misfit < 1e-6
        assert fit.response(F) == pytest.approx(exact(F) if gain > 0 else exact(F, -0.3) / (1 + LEAD * 2j * np.pi * F))
    assert fits[0].lead[0] == pytest.approx(LEAD, rel=1e-6)


def test_a_delay_that_the_fit_does_not_know_shows_as_misfit() -> None:
    late = of(exact(F) * np.exp(-2j * np.pi * F * 0.1))
    assert fit_second_order([late], [0])[0].misfit > 0.1


def test_bandwidths_of_a_lag_of_first_order() -> None:
    corner = 1.3
    read = bandwidth(of(3.0 / (1.0 + 1j * F / corner)))
    assert read.phase_bandwidth == pytest.approx(corner, rel=1e-3)
    assert read.equivalent_time == pytest.approx(1.0 / (2.0 * math.pi * corner), rel=1e-3)
    # relative to the gain at the lowest frequency
    assert read.gain_bandwidth == pytest.approx(math.sqrt(2.0 * (corner**2 + 0.2**2) - corner**2), rel=2e-3)
    assert read.low_gain == pytest.approx(3.0 / math.hypot(1.0, 0.2 / corner))
    assert math.isnan(read.resonance)


def test_resonance_of_a_mass_on_a_spring_of_either_sign() -> None:
    for sign in (1.0, -1.0):
        s = 2j * np.pi * F
        read = bandwidth(of(sign / (1.0 + 2.0 * 0.2 * s / W + (s / W) ** 2)))
        assert read.resonance == pytest.approx(W / (2 * math.pi) * math.sqrt(1 - 2 * 0.2**2), rel=0.05)
        assert read.resonance_ratio == pytest.approx(1.0 / (2 * 0.2 * math.sqrt(1 - 0.2**2)), rel=0.05)
        assert 0.5 < read.phase_bandwidth < W / (2 * math.pi)


def test_phase_of_a_response_of_the_other_sign_begins_at_a_half_turn() -> None:
    lag = 1.0 / (1.0 + 1j * F / 0.5)
    for sign in (1.0, -1.0):
        actual = of(sign * lag)
        assert actual.phase[0] == pytest.approx((0.0 if sign > 0 else math.pi) - math.atan(0.4))
        assert (np.diff(actual.phase) < 0.0).all()
    assert math.isnan(of(lag).phase_at(9.0))


@pytest.mark.parametrize(
    ("n", "interval", "message"), [(500, 0.01, "needs a record of 15 s, not 5 s"), (6400, 0.2, "samples each 0.2 s")]
)
def test_a_record_that_cannot_do_is_reported(n: int, interval: float, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        frequency_response(SWEEP[:n], SWEEP[:n], interval, F)
