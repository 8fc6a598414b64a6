"""Parts left out of a fit, against fits without them; intervals of parts and of signals that differ alike."""

import numpy as np
import pytest
from scipy import stats
from scipy.signal import lfilter

from hosts.compare.correlated_residuals import covariance
from hosts.compare.cross_validation import (
    FOLDS,
    Parts,
    clustered_covariance,
    fold_changes,
    left_out_residuals,
    rms_without_each,
)

LENGTH = 10.0  # s
SAMPLES = 40


def linear(begins: np.ndarray, seed: int = 3) -> tuple[np.ndarray, np.ndarray, Parts]:
    """Jacobian and residuals at the least squares solution of a linear model, with parts of `LENGTH` seconds."""
    random = np.random.default_rng(seed)
    number = np.repeat(np.arange(len(begins)), SAMPLES)
    jacobian = random.normal(size=(len(number), 3)) * (1.0, 30.0, 0.01)
    target = random.normal(size=len(number)) + random.normal(size=len(begins))[number]
    p = np.linalg.lstsq(jacobian, target, rcond=None)[0]
    return jacobian, jacobian @ p - target, Parts(number, begins, LENGTH)


def test_what_is_left_of_a_part_is_that_of_a_fit_without_it_and_without_its_neighbours() -> None:
    jacobian, residual, parts = linear(0.5 * LENGTH * np.arange(8))
    actual = left_out_residuals(jacobian, residual, parts)
    for k, begin in enumerate(parts.begins):
        near = np.abs(parts.begins - begin) < LENGTH
        kept = ~near[parts.number]
        change = np.linalg.lstsq(jacobian[kept], -residual[kept], rcond=None)[0]
        rows = parts.number == k
        np.testing.assert_allclose(actual[rows], residual[rows] + jacobian[rows] @ change, rtol=1e-9)
    assert np.mean(actual**2) > np.mean(residual**2)


def test_the_parameters_without_a_fold_are_those_of_a_fit_without_it() -> None:
    """Of windows that are given in any order."""
    begins = 0.5 * LENGTH * np.random.default_rng(1).permutation(12)
    jacobian, residual, parts = linear(begins)
    actual = fold_changes(jacobian, residual, parts)
    assert actual.shape == (FOLDS, 3)
    for change, group in zip(actual, np.split(np.argsort(begins), FOLDS), strict=True):
        near = np.abs(begins[:, None] - begins[group]).min(axis=1) < LENGTH
        kept = ~near[parts.number]
        expected = np.linalg.lstsq(jacobian[kept], -residual[kept], rcond=None)[0]
        np.testing.assert_allclose(change, expected, rtol=1e-8)


def test_a_parameter_that_tells_nothing_does_not_pay() -> None:
    jacobian, residual, parts = linear(LENGTH * np.arange(8))
    whole = float(np.sqrt(np.mean(left_out_residuals(jacobian, residual, parts) ** 2)))
    # The first is moved far from its start; the others stand at it.
    apart = 10.0 / np.linalg.norm(jacobian[:, 0]) * np.linalg.norm(residual)
    moved, *still = rms_without_each(jacobian, residual, parts, [apart, 0.0, 0.0])
    assert moved > 2.0 * whole
    assert max(still) < whole


def test_intervals_hold_where_all_samples_of_a_window_are_off_together() -> None:
    random, begins, hits = np.random.default_rng(5), LENGTH * np.arange(12), 0
    number = np.repeat(np.arange(len(begins)), SAMPLES)
    parts, plain = Parts(number, begins, LENGTH), 0
    t, logs = float(stats.t.ppf(0.975, parts.independent - 1.0)), 400
    for _ in range(logs):
        jacobian = random.normal(size=(len(number), 1)) + random.normal(size=(len(begins), 1))[number]
        noise = random.normal(size=len(begins))[number] + 0.3 * random.normal(size=len(number))
        p = np.linalg.lstsq(jacobian, noise, rcond=None)[0]  # the true value is 0
        r = jacobian @ p - noise
        hits += abs(p[0]) <= t * np.sqrt(clustered_covariance(jacobian, r, parts)[0, 0])
        plain += abs(p[0]) <= 1.96 * np.sqrt(np.mean(r**2) / float((jacobian**2).sum()))
    print(f"\nwithin the interval of 95 %: {hits / logs:.3f}; as if all samples were independent: {plain / logs:.3f}")
    assert 0.90 < hits / logs < 0.99
    assert plain / logs < 0.6


SIGNALS = 4
TIMES = 300
MEMORY = 0.8
LOGS = 300
SHARE = 0.9


@pytest.mark.slow
def test_intervals_hold_where_signals_differ_alike() -> None:
    """Of each signal 0.9 of the noise's variance is common to all; two of them have the other sign. The value is 0.

    As if the signals were independent, 61 to 64 % of the intervals would hold.
    """
    random, t = np.random.default_rng(7), 0.02 * np.arange(TIMES)
    one = np.column_stack((np.sin(1.3 * t), np.cos(0.4 * t)))
    signs = np.array([1.0, -1.0, 1.0, -1.0])
    jacobian = np.vstack([sign * one for sign in signs])
    blocks = [slice(k * TIMES, (k + 1) * TIMES) for k in range(SIGNALS)]
    hits, widths = np.zeros(2), []
    for _ in range(LOGS):
        common, *own = lfilter([1.0], [1.0, -MEMORY], random.normal(size=(1 + SIGNALS, TIMES + 100)))[:, 100:]
        noise = [s * np.sqrt(SHARE) * common + np.sqrt(1.0 - SHARE) * x for s, x in zip(signs, own, strict=True)]
        target = np.concatenate(noise)
        p = np.linalg.lstsq(jacobian, target, rcond=None)[0]
        spread, _ = covariance(jacobian, jacobian @ p - target, blocks, SIGNALS * [t])
        widths.append(1.96 * np.sqrt(np.diag(spread)))
        hits += np.abs(p) <= widths[-1]
    print(f"\nwithin the interval of 95 %: {hits / LOGS}, half of it {np.mean(widths, axis=0)}")
    assert (hits / LOGS > 0.9).all()
    assert (hits / LOGS < 0.99).all()
