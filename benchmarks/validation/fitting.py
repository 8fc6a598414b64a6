"""Fits a bicycle to windows of a drive, from several starts, and tells how far it is off elsewhere."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from benchmarks.validation.bicycle import Body, Model, simulate
from benchmarks.validation.drive import EVERY, FITTED, JUDGED, LENGTH, Drive, Spans

Array = NDArray[np.float64]
STARTS, SEED = 2, 1
SCALES = 0.02, 0.3  # rad/s and m/s: deviations of yaw rate and lateral velocity that count the same
STEP = 1e-4  # of the differences, of the range of a number


@dataclass(frozen=True)
class Fitted:
    """A model with its numbers."""

    model: Model
    numbers: Array
    """Shape (p,)."""
    found: list[float]
    """Root mean square over the fitted seconds that each start led to, in `SCALES`."""
    fitted: float
    windows: float
    whole: float
    """`fitted`, `windows`, `whole`: root mean square of the yaw rate's deviation, rad/s: fitted windows, windows that
    were not fitted, and one run without restart over those seconds."""
    lateral: float
    """Root mean square of the lateral velocity's deviation in the windows that were not fitted, m/s; NaN: no such."""
    departed: int
    """Windows that were not fitted whose yaw rate is off by more than the range of the measured one."""
    path: Array
    """Shape (n,): yaw rate of the run without restart, rad/s."""
    predicted: tuple[Array, Array]
    """Each of shape (w, m): lateral velocity and yaw rate in the windows that were not fitted, m/s and rad/s."""


def begins(drive: Drive, seconds: Spans) -> NDArray[np.intp]:
    """First samples of the windows that lie in stretches of seconds."""
    times = [t for a, b in seconds for t in np.arange(a, b - LENGTH + 1e-9, EVERY)]
    return np.array([round((t - drive.time[0]) / drive.interval) for t in times], dtype=np.intp)


def drive_of(model: Model, *given: Any) -> tuple[Array, Array]:
    """Lateral velocity and yaw rate of a model, by its own `simulate` or that of a bicycle."""
    return (model.simulate or simulate)(model, *given)


def fit(model: Model, body: Body, drive: Drive, seconds: Spans = FITTED, others: Spans = JUDGED) -> Fitted:
    """Fit a model in the windows of some seconds, and judge it in those of others.

    What is fitted is yaw rate and lateral velocity, of a model without lateral velocity the yaw rate alone.
    """
    steps = round(LENGTH / drive.interval)
    low, high = (np.array([getattr(u, end) for u in model.unknowns]) for end in ("low", "high"))

    def both(numbers: Array, rows: NDArray[np.intp]) -> tuple[Array, Array]:
        samples = rows[:, None] + np.arange(steps + 1)
        vy, rate = drive_of(model, body, drive, rows, steps, numbers)
        return vy - drive.vy[samples], rate - drive.yaw_rate[samples]

    rows = begins(drive, seconds)

    def errors(numbers: Array) -> Array:
        """Of shape (k, n); a model without lateral velocity has that of its yaw rate alone."""
        across, turning = (e.reshape(len(e), -1) for e in both(numbers, rows))
        turning = turning / SCALES[0]
        return np.asarray(np.hstack([turning, across / SCALES[1]]) if model.moves_across else turning)

    def residuals(p: Array) -> Array:
        return np.nan_to_num(errors(p[None])[0], nan=1e3)

    def jacobian(p: Array) -> Array:
        side = np.where(p + STEP * (high - low) > high, -1.0, 1.0) * STEP * (high - low)
        e = errors(np.vstack([p, p + np.diag(side)]))
        return np.asarray(((e[1:] - e[0]) / side[:, None]).T)

    random, results = np.random.default_rng(SEED), []
    for _ in range(STARTS if len(low) else 0):
        start = low + (high - low) * random.uniform(0.2, 0.8, len(low))
        results.append(
            least_squares(residuals, start, jacobian, bounds=(low, high), x_scale=high - low, ftol=1e-6, max_nfev=60)
        )
    numbers = min(results, key=lambda r: float(r.cost)).x if results else np.zeros(0)
    judged = begins(drive, others)
    samples = judged[:, None] + np.arange(steps + 1)
    vy, rate = (found[0] for found in drive_of(model, body, drive, judged, steps, numbers[None]))
    path = drive_of(model, body, drive, np.array([0]), len(drive.time) - 1, numbers[None])[1][0, 0]
    turning = rate - drive.yaw_rate[samples]
    return Fitted(
        model,
        numbers,
        [_rms(r.fun) for r in results],
        _rms(both(numbers[None], rows)[1]),
        _rms(turning),
        _rms((path - drive.yaw_rate)[drive.inside(others)]),
        _rms(vy - drive.vy[samples]),
        int((np.abs(turning).max(axis=1) > np.ptp(drive.yaw_rate)).sum()),
        path,
        (vy, rate),
    )


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(np.square(values))))
