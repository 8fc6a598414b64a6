"""Fits a bicycle to windows of a drive, from several starts, and tells how far it is off elsewhere."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from benchmarks.validation.bicycle import Body, Model, simulate
from benchmarks.validation.drive import EVERY, FITTED, JUDGED, LENGTH, Drive

Array = NDArray[np.float64]
STARTS, SEED = 2, 1
STEP = 1e-4  # of the differences, of the range of a number


@dataclass(frozen=True)
class Fitted:
    """A model with its numbers.

    Parameters
    ----------
    numbers : ndarray of shape (p,)
    found : list of float
        Root mean square over the fitted seconds that each start led to, rad/s.
    fitted, windows, whole : float
        Root mean square of the yaw rate's deviation, rad/s: fitted windows, windows that were not fitted, and one run
        without restart over those seconds.
    lateral : float
        Root mean square of the lateral velocity's deviation in the windows that were not fitted, m/s; NaN: no such.
    departed : int
        Windows that were not fitted whose yaw rate is off by more than the range of the measured one.
    path : ndarray of shape (n,)
        Yaw rate of the run without restart, rad/s.
    """

    model: Model
    numbers: Array
    found: list[float]
    fitted: float
    windows: float
    whole: float
    lateral: float
    departed: int
    path: Array


def begins(drive: Drive, seconds: tuple[tuple[float, float], ...]) -> NDArray[np.intp]:
    """First samples of the windows that lie in stretches of seconds."""
    times = [t for a, b in seconds for t in np.arange(a, b - LENGTH + 1e-9, EVERY)]
    return np.array([round((t - drive.time[0]) / drive.interval) for t in times], dtype=np.intp)


def fit(model: Model, body: Body, drive: Drive) -> Fitted:
    """Fit a model on the yaw rate in the windows of `FITTED`, and judge it in those of `JUDGED`."""
    steps = round(LENGTH / drive.interval)
    low, high = (np.array([getattr(u, end) for u in model.unknowns]) for end in ("low", "high"))

    def both(numbers: Array, rows: NDArray[np.intp]) -> tuple[Array, Array]:
        samples = rows[:, None] + np.arange(steps + 1)
        vy, rate = simulate(model, body, drive, rows, steps, numbers)
        return vy - drive.vy[samples], rate - drive.yaw_rate[samples]

    def errors(numbers: Array, rows: NDArray[np.intp]) -> Array:
        return both(numbers, rows)[1]

    rows = begins(drive, FITTED)

    def residuals(p: Array) -> Array:
        return np.nan_to_num(errors(p[None], rows)[0].ravel(), nan=10.0)

    def jacobian(p: Array) -> Array:
        side = np.where(p + STEP * (high - low) > high, -1.0, 1.0) * STEP * (high - low)
        e = errors(np.vstack([p, p + np.diag(side)]), rows).reshape(len(p) + 1, -1)
        return np.asarray(((e[1:] - e[0]) / side[:, None]).T)

    random, results = np.random.default_rng(SEED), []
    for _ in range(STARTS if len(low) else 0):
        start = low + (high - low) * random.uniform(0.2, 0.8, len(low))
        results.append(least_squares(residuals, start, jacobian, bounds=(low, high), x_scale=high - low, max_nfev=60))
    numbers = min(results, key=lambda r: float(r.cost)).x if results else np.zeros(0)
    lateral, others = (e[0] for e in both(numbers[None], begins(drive, JUDGED)))
    path = simulate(model, body, drive, np.array([0]), len(drive.time) - 1, numbers[None])[1][0, 0]
    return Fitted(
        model,
        numbers,
        [_rms(r.fun) for r in results],
        _rms(residuals(numbers)),
        _rms(others),
        _rms((path - drive.yaw_rate)[drive.inside(JUDGED)]),
        _rms(lateral),
        int((np.abs(others).max(axis=1) > np.ptp(drive.yaw_rate)).sum()),
        path,
    )


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(np.square(values))))
