"""Delay and drift of measured signals against simulated ones, finer than a sample.

A measured signal is a + b * simulated((t - delay) / (1 + drift)). The delay that correlates best at whole samples comes
first; then delay, drift, a and b are found by least squares on the spline of the simulated signal.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy import signal as sp
from scipy.optimize import least_squares

from hosts.compare.correlated_residuals import covariance
from hosts.compare.cross_validation import FEWEST, Parts, jackknife, parts_of
from hosts.compare.curve import Curve
from hosts.compare.deviations import is_constant
from hosts.compare.noise import measured_noise
from hosts.measures.signal import Signal

_LEAST_CORRELATION = 0.5
_AMBIGUOUS = 0.01
_MOST_POINTS = 20_000
_LARGEST_DRIFT = 0.05
# A clock moves all that a log holds; a drift that explains less of what is left is one of the model, and not told.
_LEAST_EXPLAINED = 0.25
_SCATTER = 1.2  # of the square of a noise that is estimated
_ALIKE = 2.0  # of what is left and no noise: how much more of the model's difference may look like a delay


@dataclass(frozen=True)
class Alignment:
    """Delay and drift of a measured signal."""

    delay: float
    delay_error: float
    """`delay`, `delay_error`: s, and half of its 95 % interval; what happens at t in the simulation happens at delay +
    (1 + drift) t in the log. NaN where it cannot be found."""
    drift: float
    drift_error: float
    """`drift`, `drift_error`: by how much the log's clock of this signal runs fast."""
    correlation: float
    note: str = ""
    explained: float = 0.0
    """Part of the squared residuals without a drift that the drift takes away."""

    @property
    def has_drift(self) -> bool:
        """Whether the drift is beyond two of its errors and explains a quarter of what is left without it; one at which
        the search ends is none.
        """
        certain = 2.0 * self.drift_error < abs(self.drift) < 0.99 * _LARGEST_DRIFT
        return certain and self.explained >= _LEAST_EXPLAINED


def align(pairs: Sequence[tuple[Signal, Curve]], longest: float, drift: bool = True) -> Alignment:
    """The delay and drift that signals have in common; of one signal, its own.

    `pairs`: measured and simulated; `longest`: largest delay that is looked for, s.
    """
    pairs = [(s, c) for s, c in pairs if not is_constant(s.values) and not is_constant(c(s.time))]
    if not pairs:
        return Alignment(*5 * (math.nan,), "no signal moves in both")
    coarse, peak, rival, level = _coarse(pairs, longest)
    if peak < _LEAST_CORRELATION:
        return Alignment(*4 * (math.nan,), peak, f"the best correlation is {peak:.2f}: no delay can be determined")
    if level:
        message = f"signals correlate by {peak:.3f}, and nearly as well with any delay that so short a log can have"
        return Alignment(*4 * (math.nan,), peak, message)
    fine = _fine(pairs, coarse, drift)
    if drift and not fine.has_drift:  # which has taken a part of the delay
        alone = _fine(pairs, coarse, False)
        fine = replace(fine, delay=alone.delay, delay_error=alone.delay_error, correlation=alone.correlation)
    note = f"a delay of {rival:.3g} s fits nearly as well" if rival is not None else ""
    if abs(fine.delay) > longest:
        message = f"no delay up to {longest:g} s, which was looked for (--longest-delay), fits best"
        return Alignment(*4 * (math.nan,), fine.correlation, message)
    return replace(fine, note=note)


def _coarse(pairs: Sequence[tuple[Signal, Curve]], longest: float) -> tuple[float, float, float | None, bool]:
    """Delay at whole samples, mean correlation there, another delay that is nearly as good, and whether all are.

    The last is judged where the log is too short for all delays that were to be looked for.
    """
    begin, end = min(s.time[0] for s, _ in pairs), max(s.time[-1] for s, _ in pairs)
    interval = max(min(s.interval for s, _ in pairs), (end - begin) / _MOST_POINTS)
    lags = np.zeros(0)
    total: NDArray[np.float64] = np.zeros(0)
    for measured, curve in pairs:
        grid = np.arange(measured.time[0], measured.time[-1], interval)
        y, x = np.interp(grid, measured.time, measured.values), curve(grid)
        lags, result = _correlations(y, x, min(int(longest / interval), len(grid) // 2))
        if len(total) not in (0, len(result)):
            few = min(len(total), len(result)) // 2
            total, result = (a[len(a) // 2 - few : len(a) // 2 + few + 1] for a in (total, result))
            lags = lags[len(lags) // 2 - few : len(lags) // 2 + few + 1]
        total = result if not len(total) else total + result
    total = total / len(pairs)
    # Among equals the smallest delay: of a periodic signal a period more fits as well.
    best = int(np.argmax(total - 1e-6 * np.abs(lags)))
    peaks, _ = sp.find_peaks(total)
    rivals = [k for k in peaks if abs(lags[k] - lags[best]) > 2 and total[k] > total[best] - _AMBIGUOUS]
    rival = float(interval * lags[min(rivals, key=lambda k: abs(lags[k]))]) if rivals else None
    level = bool(lags[-1] < int(longest / interval) and total.min() > total[best] - _AMBIGUOUS)
    return float(interval * lags[best]), float(total[best]), rival, level


def _correlations(
    y: NDArray[np.float64], x: NDArray[np.float64], most: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Pearson's coefficient of y[k + lag] and x[k] over what overlaps, for lags of -most to most."""
    y, x, ones = y - y.mean(), x - x.mean(), np.ones(len(y))
    lags = sp.correlation_lags(len(y), len(x))
    chosen = np.abs(lags) <= most

    def sums(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.asarray(sp.correlate(a, b, method="fft"))[chosen]

    count = np.maximum(np.round(sums(ones, ones)), 1.0)
    y1, x1 = sums(y, ones) / count, sums(ones, x) / count
    variance = (sums(y * y, ones) / count - y1**2) * (sums(ones, x * x) / count - x1**2)
    least = 1e-6 * float(np.var(y) * np.var(x))  # of an overlap in which nothing happens
    result = np.where(variance > least, (sums(y, x) / count - y1 * x1) / np.sqrt(np.maximum(variance, least)), 0.0)
    return lags[chosen].astype(float), result


def _fine(pairs: Sequence[tuple[Signal, Curve]], delay: float, drift: bool) -> Alignment:
    # What is measured before the simulation begins, or after its end, has nothing to be held against.
    pairs = [(_overlap(s, c, delay), c) for s, c in pairs]
    spreads = [float(np.std(s.values)) for s, _ in pairs]

    def residual(p: NDArray[np.float64]) -> NDArray[np.float64]:
        parts = []
        for (s, curve), spread in zip(pairs, spreads, strict=True):
            x = curve((s.time - p[0]) / (1.0 + (p[1] if drift else 0.0)))
            design = np.column_stack((np.ones(len(x)), x))
            scales = np.linalg.lstsq(design, s.values, rcond=None)[0]
            parts.append((s.values - design @ scales) / spread)
        return np.concatenate(parts)

    interval = min(s.interval for s, _ in pairs)
    length = max(s.time[-1] for s, _ in pairs)
    size = [interval, interval / length][: 1 + drift]
    start = [delay, 0.0][: 1 + drift]
    limit = _LARGEST_DRIFT
    bounds = ([-np.inf, -limit][: 1 + drift], [np.inf, limit][: 1 + drift])
    solution = least_squares(residual, start, x_scale=size, bounds=bounds, jac=_central(residual, size))
    rows, first = [], 0
    for s, _ in pairs:
        rows.append(slice(first, first + len(s.time)))
        first += len(s.time)
    jacobian = np.asarray(solution.jac)
    errors = 1.96 * np.sqrt(np.diag(covariance(jacobian, solution.fun, rows, [s.time for s, _ in pairs])[0]))
    for parts in _parts([s for s, _ in pairs]):
        errors = np.maximum(errors, jackknife(jacobian, solution.fun, parts))
    # What is left and no noise may be a difference of the model, and another part of it as large look like a delay.
    white = [
        len(s.time) * (measured_noise(s.values) / d) ** 2 for s, d in zip((s for s, _ in pairs), spreads, strict=True)
    ]
    sums = [float(solution.fun[r] @ solution.fun[r]) - _SCATTER * w for r, w in zip(rows, white, strict=True)]
    alone = np.sqrt(np.diag(np.linalg.pinv(jacobian.T @ jacobian)))
    errors = np.maximum(errors, _ALIKE * math.sqrt(sum(max(x, 0.0) for x in sums)) * alone)
    unexplained = float(np.mean(solution.fun**2))
    correlation = math.sqrt(max(0.0, 1.0 - unexplained))
    if not drift:
        return Alignment(float(solution.x[0]), float(errors[0]), 0.0, 0.0, correlation)
    # To first order: the delay takes the best part of the drift's place when the drift is left out.
    late, fast = jacobian.T
    by_drift = float(solution.x[1] ** 2 * (fast @ fast - (late @ fast) ** 2 / (late @ late)))
    explained = by_drift / (by_drift + float(solution.fun @ solution.fun)) if by_drift > 0.0 else 0.0
    drifts = float(solution.x[1]), float(errors[1])
    return Alignment(float(solution.x[0]), float(errors[0]), *drifts, correlation, explained=explained)


def _parts(signals: Sequence[Signal]) -> list[Parts]:
    """What is left out in turn: tenths of the log, and each signal where there are enough of them."""
    results = [parts_of({str(k): s for k, s in enumerate(signals)}, ())]
    if len(signals) >= FEWEST:
        number = np.repeat(np.arange(len(signals)), [len(s.time) for s in signals])
        results.append(Parts(number, np.arange(len(signals), dtype=float), 1.0))
    return results


def _overlap(signal: Signal, curve: Curve, delay: float) -> Signal:
    margin = 2.0 * signal.interval
    return signal.between(delay + margin, delay + curve.end - margin)


def _central(
    residual: Callable[[NDArray[np.float64]], NDArray[np.float64]], size: Sequence[float]
) -> Callable[[NDArray[np.float64]], NDArray[np.float64]]:
    """Central differences with steps of a thousandth of a sample; the spline is exact to rounding errors."""

    def jacobian(p: NDArray[np.float64]) -> NDArray[np.float64]:
        steps = 1e-3 * np.diag(size)
        return np.column_stack([(residual(p + h) - residual(p - h)) / (2.0 * h.sum()) for h in steps])

    return jacobian
