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
from hosts.compare.cross_validation import MIN_PARTS, Parts, jackknife, parts_of
from hosts.compare.curve import Curve
from hosts.compare.deviations import is_constant
from hosts.compare.noise import measured_noise
from hosts.measures.signal import Signal

_MIN_CORRELATION = 0.5
_AMBIGUOUS = 0.01
_MAX_POINTS = 20_000
_MAX_DRIFT = 0.05
_MIN_EXPLAINED_FRACTION = 0.25  # of the squared residuals; a drift that explains less is an error of the model
_NOISE_FACTOR = 1.2  # on the squared noise, which is an estimate
_MODEL_FACTOR = 2.0  # on the residual of the model, of which another part may look like a delay


@dataclass(frozen=True)
class Alignment:
    """Delay and drift of a measured signal."""

    delay: float = math.nan
    """s; time t of the simulation is time delay + (1 + drift) t of the log. NaN if it cannot be determined."""
    delay_error: float = math.nan
    """Half of the 95 % interval of `delay`, s."""
    drift: float = math.nan
    """Relative rate error of the log's clock of this signal; positive: the clock runs fast."""
    drift_error: float = math.nan
    """Half of the 95 % interval of `drift`."""
    correlation: float = math.nan
    note: str = ""
    explained: float = 0.0
    """Fraction of the squared residuals without a drift that the drift explains."""

    @property
    def has_drift(self) -> bool:
        """Whether the drift exceeds twice its error, explains enough and is below the limit of the search."""
        certain = 2.0 * self.drift_error < abs(self.drift) < 0.99 * _MAX_DRIFT
        return certain and self.explained >= _MIN_EXPLAINED_FRACTION


def align(pairs: Sequence[tuple[Signal, Curve]], longest: float, drift: bool = True) -> Alignment:
    """The common delay and drift of signals.

    `pairs`: measured and simulated signals; `longest`: largest delay of the search, s; `drift`: whether a drift is
    estimated.
    """
    pairs = [(s, c) for s, c in pairs if not is_constant(s.values) and not is_constant(c(s.time))]
    if not pairs:
        return Alignment(note="no signal moves in both")
    first_delay, peak, other_delay, is_flat = _coarse_delay(pairs, longest)
    if peak < _MIN_CORRELATION:
        return Alignment(correlation=peak, note=f"the best correlation is {peak:.2f}: no delay can be determined")
    if is_flat:
        message = f"signals correlate by {peak:.3f}, and nearly as well with any delay that so short a log can have"
        return Alignment(correlation=peak, note=message)
    fine = _least_squares_alignment(pairs, first_delay, drift)
    if drift and not fine.has_drift:  # a drift that is not significant biases the delay
        constant = _least_squares_alignment(pairs, first_delay, False)
        fine = replace(fine, delay=constant.delay, delay_error=constant.delay_error, correlation=constant.correlation)
    note = f"a delay of {other_delay:.3g} s fits nearly as well" if other_delay is not None else ""
    if abs(fine.delay) > longest:
        message = f"no delay up to {longest:g} s, which was looked for (--longest-delay), fits best"
        return Alignment(correlation=fine.correlation, note=message)
    return replace(fine, note=note)


def _coarse_delay(pairs: Sequence[tuple[Signal, Curve]], longest: float) -> tuple[float, float, float | None, bool]:
    """Delay by the largest correlation at whole samples.

    Returns the delay, s, its mean correlation, another delay that correlates nearly as well, and whether all delays of
    a log that is shorter than the range of the search do so.
    """
    begin, end = min(s.time[0] for s, _ in pairs), max(s.time[-1] for s, _ in pairs)
    interval = max(min(s.interval for s, _ in pairs), (end - begin) / _MAX_POINTS)
    lags = np.zeros(0)
    total: NDArray[np.float64] = np.zeros(0)
    for measured, curve in pairs:
        grid = np.arange(measured.time[0], measured.time[-1], interval)
        y, x = np.interp(grid, measured.time, measured.values), curve(grid)
        lags, result = _cross_correlation(y, x, min(int(longest / interval), len(grid) // 2))
        if len(total) not in (0, len(result)):
            half = min(len(total), len(result)) // 2
            total, result = (a[len(a) // 2 - half : len(a) // 2 + half + 1] for a in (total, result))
            lags = lags[len(lags) // 2 - half : len(lags) // 2 + half + 1]
        total = result if not len(total) else total + result
    total = total / len(pairs)
    # Of equal correlations the smallest delay: a periodic signal correlates as well one period later.
    best = int(np.argmax(total - 1e-6 * np.abs(lags)))
    peaks, _ = sp.find_peaks(total)
    other_peaks = [k for k in peaks if abs(lags[k] - lags[best]) > 2 and total[k] > total[best] - _AMBIGUOUS]
    other_delay = float(interval * lags[min(other_peaks, key=lambda k: abs(lags[k]))]) if other_peaks else None
    is_flat = bool(lags[-1] < int(longest / interval) and total.min() > total[best] - _AMBIGUOUS)
    return float(interval * lags[best]), float(total[best]), other_delay, is_flat


def _cross_correlation(
    y: NDArray[np.float64], x: NDArray[np.float64], largest_lag: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Pearson's coefficient of y[k + lag] and x[k] over their overlap, for lags from -largest_lag to largest_lag."""
    y, x, ones = y - y.mean(), x - x.mean(), np.ones(len(y))
    lags = sp.correlation_lags(len(y), len(x))
    selected = np.abs(lags) <= largest_lag

    def sums(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.asarray(sp.correlate(a, b, method="fft"))[selected]

    count = np.maximum(np.round(sums(ones, ones)), 1.0)
    y1, x1 = sums(y, ones) / count, sums(ones, x) / count
    variance = (sums(y * y, ones) / count - y1**2) * (sums(ones, x * x) / count - x1**2)
    least_variance = 1e-6 * float(np.var(y) * np.var(x))  # below it the overlap is constant
    result = np.where(
        variance > least_variance, (sums(y, x) / count - y1 * x1) / np.sqrt(np.maximum(variance, least_variance)), 0.0
    )
    return lags[selected].astype(float), result


def _least_squares_alignment(pairs: Sequence[tuple[Signal, Curve]], delay: float, drift: bool) -> Alignment:
    """Delay, and drift if it is estimated, by least squares from a first delay, s."""
    pairs = [(_overlapping_samples(s, c, delay), c) for s, c in pairs]
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
    limit = _MAX_DRIFT
    bounds = ([-np.inf, -limit][: 1 + drift], [np.inf, limit][: 1 + drift])
    solution = least_squares(residual, start, x_scale=size, bounds=bounds, jac=_central_differences(residual, size))
    rows, first = [], 0
    for s, _ in pairs:
        rows.append(slice(first, first + len(s.time)))
        first += len(s.time)
    jacobian = np.asarray(solution.jac)
    errors = 1.96 * np.sqrt(np.diag(covariance(jacobian, solution.fun, rows, [s.time for s, _ in pairs])[0]))
    for parts in _omitted_parts([s for s, _ in pairs]):
        errors = np.maximum(errors, jackknife(jacobian, solution.fun, parts))
    # Residuals beyond the noise are an error of the model, of which another part of that size may look like a delay.
    noise_sums = [
        len(s.time) * (measured_noise(s.values) / d) ** 2 for s, d in zip((s for s, _ in pairs), spreads, strict=True)
    ]
    model_sums = [
        float(solution.fun[r] @ solution.fun[r]) - _NOISE_FACTOR * w for r, w in zip(rows, noise_sums, strict=True)
    ]
    standard_errors = np.sqrt(np.diag(np.linalg.pinv(jacobian.T @ jacobian)))
    errors = np.maximum(errors, _MODEL_FACTOR * math.sqrt(sum(max(x, 0.0) for x in model_sums)) * standard_errors)
    unexplained = float(np.mean(solution.fun**2))
    correlation = math.sqrt(max(0.0, 1.0 - unexplained))
    if not drift:
        return Alignment(float(solution.x[0]), float(errors[0]), 0.0, 0.0, correlation)
    # To first order the delay compensates a drift that is left out as far as both columns are parallel.
    by_delay, by_drift_rate = jacobian.T
    by_drift = float(
        solution.x[1] ** 2 * (by_drift_rate @ by_drift_rate - (by_delay @ by_drift_rate) ** 2 / (by_delay @ by_delay))
    )
    explained = by_drift / (by_drift + float(solution.fun @ solution.fun)) if by_drift > 0.0 else 0.0
    drifts = float(solution.x[1]), float(errors[1])
    return Alignment(float(solution.x[0]), float(errors[0]), *drifts, correlation, explained=explained)


def _omitted_parts(signals: Sequence[Signal]) -> list[Parts]:
    """Parts that are left out in turn: tenths of the log, and each signal if there are enough of them."""
    results = [parts_of({str(k): s for k, s in enumerate(signals)}, ())]
    if len(signals) >= MIN_PARTS:
        number = np.repeat(np.arange(len(signals)), [len(s.time) for s in signals])
        results.append(Parts(number, np.arange(len(signals), dtype=float), 1.0))
    return results


def _overlapping_samples(signal: Signal, curve: Curve, delay: float) -> Signal:
    margin = 2.0 * signal.interval
    return signal.between(delay + margin, delay + curve.end - margin)


def _central_differences(
    residual: Callable[[NDArray[np.float64]], NDArray[np.float64]], size: Sequence[float]
) -> Callable[[NDArray[np.float64]], NDArray[np.float64]]:
    """The Jacobian by central differences with steps of a thousandth of `size`."""

    def jacobian(p: NDArray[np.float64]) -> NDArray[np.float64]:
        steps = 1e-3 * np.diag(size)
        return np.column_stack([(residual(p + h) - residual(p - h)) / (2.0 * h.sum()) for h in steps])

    return jacobian
