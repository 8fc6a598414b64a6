"""Main effects: the mean of a measure over one parameter, averaged over the others."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from hosts.study.limits import CONFIDENCE, interval_of_share

_MAX_LEVELS = 12  # distinct values; more are divided into classes
_MAX_BINS = 10
_MIN_RUNS_IN_BIN = 5
_MIN_RUNS_FOR_NORMAL = 500  # runs; intervals of fewer are by the bootstrap
_RESAMPLES = 999


@dataclass(frozen=True)
class MainEffect:
    """Means of a measure in classes of a parameter."""

    at: NDArray[np.float64]
    """Shape (b,): level of the parameter, or its mean in the class."""
    mean: NDArray[np.float64]
    low: NDArray[np.float64]
    high: NDArray[np.float64]
    """`mean`, `low`, `high`, shape (b,): mean of the measure and its 95 % interval, which is NaN for a class of one
    run."""

    @property
    def span(self) -> float:
        """Difference of the largest and the smallest mean, in the unit of the measure."""
        return float(self.mean.max() - self.mean.min())


def classes(x: NDArray[np.float64]) -> NDArray[np.int64]:
    """Class of each value: its level, or one of up to ten classes of equal size; shape (n,)."""
    levels, codes = np.unique(x, return_inverse=True)
    if len(levels) <= _MAX_LEVELS:
        return codes.astype(np.int64)
    bins = int(np.clip(len(x) // _MIN_RUNS_IN_BIN, 1, _MAX_BINS))
    ranks = stats.rankdata(x, method="min") - 1.0
    codes = np.minimum(ranks * bins // len(x), bins - 1).astype(np.int64)
    return np.unique(codes, return_inverse=True)[1].astype(np.int64)


def main_effect(x: NDArray[np.float64], y: NDArray[np.float64], seed: int = 0) -> MainEffect:
    """The main effect of a parameter.

    `x`, `y`: parameter and measure of each run, shape (n,), n at least 1; `seed`: seed of the bootstrap. The intervals
    are percentiles of the bootstrap, or of the normal distribution for more than 500 runs.
    """
    rng = np.random.default_rng(seed)
    return _effect_of_classes(x, y, lambda of_class: _interval(of_class, rng))


def failed_share(x: NDArray[np.float64], failed: NDArray[np.bool_]) -> MainEffect:
    """Fraction of failed runs, 0 to 1, with Wilson's interval. `x`, `failed`: parameter and status of runs, (n,)."""
    return _effect_of_classes(x, failed, lambda of_class: interval_of_share(int(of_class.sum()), len(of_class)))


def _effect_of_classes(
    x: NDArray[np.float64], y: NDArray[Any], interval: Callable[[NDArray[Any]], tuple[float, float]]
) -> MainEffect:
    codes = classes(x)
    groups = np.split(np.argsort(codes, kind="stable"), np.cumsum(np.bincount(codes))[:-1])
    return MainEffect(*np.array([(x[g].mean(), y[g].mean(), *interval(y[g])) for g in groups]).T)


def _interval(y: NDArray[np.float64], rng: np.random.Generator) -> tuple[float, float]:
    if len(y) == 1:
        return float("nan"), float("nan")
    if np.ptp(y) == 0.0:
        return float(y[0]), float(y[0])
    if len(y) > _MIN_RUNS_FOR_NORMAL:
        half = float(stats.norm.ppf(0.5 + 0.5 * CONFIDENCE)) * float(y.std(ddof=1)) / np.sqrt(len(y))
        return float(y.mean() - half), float(y.mean() + half)
    means = y[rng.integers(len(y), size=(_RESAMPLES, len(y)))].mean(axis=1)
    low, high = np.quantile(means, [0.5 - 0.5 * CONFIDENCE, 0.5 + 0.5 * CONFIDENCE])
    return float(low), float(high)
