"""Confidence intervals of parameters with correlated residuals of signals, against many logs."""

import numpy as np
import pytest
from scipy.signal import lfilter

from hosts.compare.correlated_residuals import covariance

SIGNALS = 4
SAMPLES = 300
MEMORY = 0.8
LOGS = 300
SHARE = 0.9


@pytest.mark.slow
def test_intervals_hold_where_signals_differ_alike() -> None:
    """Of each signal 0.9 of the noise's variance is common to all; two of them have the other sign. The value is 0.

    As if the signals were independent, 61 to 64 % of the intervals would hold.
    """
    random, t = np.random.default_rng(7), 0.02 * np.arange(SAMPLES)
    one = np.column_stack((np.sin(1.3 * t), np.cos(0.4 * t)))
    signs = np.array([1.0, -1.0, 1.0, -1.0])
    jacobian = np.vstack([sign * one for sign in signs])
    blocks = [slice(k * SAMPLES, (k + 1) * SAMPLES) for k in range(SIGNALS)]
    hits, widths = np.zeros(2), []
    for _ in range(LOGS):
        common, *own = lfilter([1.0], [1.0, -MEMORY], random.normal(size=(1 + SIGNALS, SAMPLES + 100)))[:, 100:]
        noise = [s * np.sqrt(SHARE) * common + np.sqrt(1.0 - SHARE) * x for s, x in zip(signs, own, strict=True)]
        target = np.concatenate(noise)
        p = np.linalg.lstsq(jacobian, target, rcond=None)[0]
        spread, _ = covariance(jacobian, jacobian @ p - target, blocks, SIGNALS * [t])
        widths.append(1.96 * np.sqrt(np.diag(spread)))
        hits += np.abs(p) <= widths[-1]
    print(f"\nwithin the interval of 95 %: {hits / LOGS}, half of it {np.mean(widths, axis=0)}")
    assert (hits / LOGS > 0.9).all()
    assert (hits / LOGS < 0.99).all()
