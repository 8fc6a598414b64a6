"""Main effects and Sobol' indices against closed forms."""

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.stats import qmc

from hosts.study.analysis.indices import Indices, estimated_indices, grid_indices, saltelli_indices
from hosts.study.analysis.main_effects import classes, main_effect
from hosts.study.random_points import saltelli as unit_points

pytest.importorskip("SALib")
NAMES = ("a", "b", "c")
# Ishigami's function with 7 and 0.1; T. Homma, A. Saltelli, Reliability Engineering and System Safety 52, 1996, 1-17.
_B, _C, _PI = 7.0, 0.1, np.pi
_V1, _V2, _V13 = 0.5 * (1.0 + _C * _PI**4 / 5.0) ** 2, _B**2 / 8.0, _C**2 * _PI**8 * (1.0 / 18.0 - 1.0 / 50.0)
_V = _V1 + _V2 + _V13
FIRST = np.array([_V1, _V2, 0.0]) / _V
TOTAL = np.array([_V1 + _V13, _V2, _V13]) / _V


def ishigami(x: NDArray[np.float64]) -> NDArray[np.float64]:
    a, b, c = x.T
    return np.asarray(np.sin(a) + _B * np.sin(b) ** 2 + _C * c**4 * np.sin(a))


def saltelli(blocks: int, seed: int = 3) -> NDArray[np.float64]:
    return (2.0 * unit_points(3, seed)(0, 5 * blocks) - 1.0) * np.pi


def test_ishigami() -> None:
    y = ishigami(saltelli(1024))
    indices = saltelli_indices(NAMES, np.arange(len(y)), y)
    assert isinstance(indices, Indices)
    assert indices.first == pytest.approx(FIRST, abs=0.02)
    assert indices.total == pytest.approx(TOTAL, abs=0.02)
    assert (indices.first_conf < 0.1).all()


def test_intervals_hold_the_truth_for_most_seeds() -> None:
    """Of 95 %; the points of a sequence are not independent, so single indices are held less or more often."""
    covered = []
    for seed in range(100):
        y = ishigami(saltelli(64, seed))
        indices = saltelli_indices(NAMES, np.arange(len(y)), y)
        assert isinstance(indices, Indices)
        covered.append(
            [np.abs(indices.first - FIRST) < indices.first_conf, np.abs(indices.total - TOTAL) < indices.total_conf]
        )
    assert np.mean(covered) > 0.93
    assert np.mean(covered, axis=0).min() > 0.75


def test_rows_in_any_order_and_blocks_with_a_missing_run() -> None:
    y = ishigami(saltelli(1024))
    rng = np.random.default_rng(5)
    points = rng.permutation(np.delete(np.arange(len(y)), [7, 8, 100, 4001]))
    indices = saltelli_indices(NAMES, points, y[points])
    assert isinstance(indices, Indices)
    assert "from 1021 blocks of 5 runs; blocks with a missing or failed run left out: 3" in indices.how
    assert indices.first == pytest.approx(FIRST, abs=0.02)
    # Not left out but moved up, the rows after the first gap would belong to other columns.
    moved = saltelli_indices(NAMES, np.arange(len(y) - 4), np.delete(y, [7, 8, 100, 4001]))
    assert isinstance(moved, Indices)
    assert not np.allclose(moved.first, FIRST, atol=0.05)


def test_a_study_half_done() -> None:
    y = ishigami(saltelli(1024))
    indices = saltelli_indices(NAMES, np.arange(2503), y[:2503])
    assert isinstance(indices, Indices)
    assert "from 500 blocks" in indices.how
    assert (np.abs(indices.total - TOTAL) < indices.total_conf).all()
    assert (indices.total_conf < 0.2).all()
    few = saltelli_indices(NAMES, np.arange(22), y[:22])
    assert few == "Only 4 blocks of 5 runs of the design are whole; indices need 64."


def test_linear_model() -> None:
    slopes, widths = np.array([3.0, -2.0, 0.5]), np.array([1.0, 2.0, 4.0])
    x = saltelli(256) / (2.0 * np.pi) * widths + 10.0
    y = x @ slopes - 40.0
    expected = (slopes * widths) ** 2 / ((slopes * widths) ** 2).sum()
    indices = saltelli_indices(NAMES, np.arange(len(y)), y)
    assert isinstance(indices, Indices)
    assert indices.first == pytest.approx(expected, abs=0.01)
    assert indices.total == pytest.approx(expected, abs=0.01)
    latin = qmc.LatinHypercube(3, rng=1).random(4000) * widths + 10.0
    estimate = estimated_indices(NAMES, latin, latin @ slopes)
    assert isinstance(estimate, Indices)
    assert estimate.first == pytest.approx(expected, abs=0.03)
    assert (np.abs(estimate.first - expected) < estimate.first_conf).all()
    assert np.isnan(estimate.total).all()
    assert "estimate" in estimate.how
    assert estimated_indices(NAMES, latin[:50], latin[:50] @ slopes) == (
        "50 runs yield the measure; estimated indices need 64."
    )


def test_a_grid_is_exact() -> None:
    a, b, c = (g.ravel() for g in np.meshgrid([-1.0, 1.0], [-1.0, 0.0, 1.0], [0.0, 5.0], indexing="ij"))
    x, order = np.stack([a, b, c], axis=1), np.random.default_rng(0).permutation(12)
    # A product of centred levels: each alone makes nothing, both together all but the part of c.
    y = 3.0 * a * b + 0.4 * c
    product, linear = 9.0 * 2.0 / 3.0, 0.4**2 * 2.5**2
    actual = grid_indices(NAMES, x[order], y[order])
    assert isinstance(actual, Indices)
    assert actual.first * (product + linear) == pytest.approx([0.0, 0.0, linear], abs=1e-12)
    assert actual.total * (product + linear) == pytest.approx([product, product, linear], abs=1e-12)
    assert grid_indices(NAMES, x[1:], y[1:]) == "The grid is not full: 11 of 12 points yield the measure."


def test_a_constant_measure_has_no_indices() -> None:
    points, x = np.arange(500), qmc.LatinHypercube(3, rng=2).random(500)
    y = np.full(500, 2.5)
    for actual in (saltelli_indices(NAMES, points, y), estimated_indices(NAMES, x, y)):
        assert actual == "The measure is 2.5 in all runs."


def test_main_effects_of_an_additive_function() -> None:
    """The mean over a class of a is that of f(a), plus the means of the others."""
    rng = np.random.default_rng(1)
    covered = []
    for repeat in range(40):
        a, b = rng.random((2, 300))
        y = np.sin(2.0 * a) + 4.0 * (b - 0.5) + 3.0
        effect = main_effect(a, y, repeat)
        assert len(effect.at) == 10
        codes = classes(a)
        assert np.bincount(codes).tolist() == [30] * 10
        expected = np.array([np.sin(2.0 * a[codes == k]).mean() + 3.0 for k in range(10)])
        covered.append((effect.low <= expected) & (expected <= effect.high))
        assert effect.span > 0.3
    # Intervals of 95 %: the bootstrap by percentiles is a little short for 30 runs.
    assert 0.90 < np.mean(covered) < 0.98


def test_main_effects_of_many_runs_and_of_levels() -> None:
    rng = np.random.default_rng(2)
    a, b = rng.integers(0, 3, 6000).astype(float), rng.normal(size=6000)
    effect = main_effect(a, -2.0 * a + b)
    assert effect.at.tolist() == [0.0, 1.0, 2.0]
    assert effect.mean == pytest.approx([0.0, -2.0, -4.0], abs=0.1)
    # The standard error of 2000 values of unit variance.
    assert effect.high - effect.low == pytest.approx(np.full(3, 2 * 1.96 / np.sqrt(2000.0)), rel=0.1)


def test_a_class_with_one_run_has_no_interval() -> None:
    effect = main_effect(np.array([1.0, 2.0, 2.0]), np.array([5.0, 6.0, 8.0]))
    assert effect.mean.tolist() == [5.0, 7.0]
    assert np.isnan(effect.low[0])
    assert effect.low[1] == 6.0
