"""The frequency weighting against the published table of its factors, and the measures against closed forms."""

import math

import numpy as np
import pytest
from scipy.signal import freqs

from hosts.measures.vibration import MAX_STEP, largest_running_rms, vibration_dose, weighted, weighting_wk

# Wk at the exact frequencies 10^(k/10) Hz of one-third octaves, as tables of ISO 2631-1 give it.
TABLE = {-3: 0.418, 0: 0.482, 3: 0.531, 5: 0.804, 6: 0.967, 7: 1.039, 8: 1.054, 9: 1.036, 10: 0.988, 11: 0.902}
TABLE |= {12: 0.768, 13: 0.636, 14: 0.513, 15: 0.405, 16: 0.314, 17: 0.246, 18: 0.186, 19: 0.132}


def test_weighting_has_the_factors_of_the_table():
    frequencies = np.array([10.0 ** (k / 10) for k in TABLE])
    gains = np.abs(freqs(*weighting_wk(), 2 * math.pi * frequencies)[1])
    # beyond 63 Hz the rounded corners of the formula differ from the table by 1.5 %
    np.testing.assert_allclose(gains, list(TABLE.values()), rtol=0.015)
    np.testing.assert_allclose(gains[:-1], list(TABLE.values())[:-1], rtol=0.009)


@pytest.mark.parametrize(
    ("step", "frequency", "accuracy"), [(0.001, 50.0, 0.011), (MAX_STEP, 20.0, 0.031), (1e-4, 1.0, 0.005)]
)
def test_filter_of_samples_weights_a_sine_as_the_transfer_function_does(step, frequency, accuracy):
    time = np.arange(0.0, 20.0, step)
    felt = weighted(np.sin(2 * math.pi * frequency * time), step)[len(time) // 2 :]
    gain = abs(freqs(*weighting_wk(), [2 * math.pi * frequency])[1][0])
    assert math.sqrt(2 * np.mean(felt**2)) == pytest.approx(gain, rel=accuracy)


def test_a_steady_acceleration_is_not_felt():
    assert abs(weighted(np.full(20_000, 9.81), 0.001)[-1]) < 1e-3


def test_running_rms_and_dose_of_a_burst():
    step = 0.001
    time = np.arange(0.0, 5.0, step)
    burst = np.where((time >= 2.0) & (time < 2.5), 3.0, 0.0)
    # half of the window of 1 s is filled
    assert largest_running_rms(burst, step) == pytest.approx(3.0 * math.sqrt(0.5), rel=1e-9)
    assert vibration_dose(burst, step) == pytest.approx(3.0 * 0.5**0.25, rel=1e-3)
    # a short record counts as if there were nothing before it
    assert largest_running_rms(burst[2000:2250], step) == pytest.approx(3.0 * math.sqrt(0.25), rel=1e-9)
