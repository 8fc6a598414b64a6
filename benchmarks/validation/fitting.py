"""Fits a bicycle model to windows of a drive from several starts, and computes its errors in other windows."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from benchmarks.validation.bicycle import Body, Model, simulate
from benchmarks.validation.drive import EVERY, FITTED, JUDGED, LENGTH, Drive, Spans

Array = NDArray[np.float64]
STARTS = 2
SEED = 1
SCALES = 0.02, 0.3  # rad/s and m/s: weights of errors of yaw rate and lateral velocity
STEP = 1e-4  # step of the difference quotients relative to the range of a parameter


@dataclass(frozen=True)
class Fitted:
    """A model with its fitted parameters and errors."""

    model: Model
    numbers: Array
    """Parameters, shape (p,)."""
    deviations: list[float]
    """Root mean square error in the fitted windows after the fit from each start, in `SCALES`."""
    fitted: float
    """Root mean square error of the yaw rate in the fitted windows, rad/s."""
    windows: float
    """Root mean square error of the yaw rate in the other windows, rad/s."""
    whole: float
    """Root mean square error of the yaw rate of a run without restart in the other seconds, rad/s."""
    lateral: float
    """Root mean square error of the lateral velocity in the other windows, m/s; NaN: the model has none."""
    departed: int
    """Number of other windows with a yaw-rate error above the range of the measured yaw rate."""
    path: Array
    """Yaw rate of the run without restart, rad/s, shape (n,)."""
    predicted: tuple[Array, Array]
    """Lateral velocity, m/s, and yaw rate, rad/s, in the windows that were not fitted, shape (w, m) each."""


def begins(drive: Drive, seconds: Spans, every: float = EVERY) -> NDArray[np.intp]:
    """Indices of the first samples of the windows in spans of time. `every`: interval between the starts of
    windows, s.
    """
    times = [t for a, b in seconds for t in np.arange(a, b - LENGTH + 1e-9, every)]
    return np.array([round((t - drive.time[0]) / drive.interval) for t in times], dtype=np.intp)


def simulate_model(model: Model, *arguments: Any) -> tuple[Array, Array]:
    """Lateral velocity (m/s) and yaw rate (rad/s) of a model, by its own `simulate` or `bicycle.simulate`."""
    return (model.simulate or simulate)(model, *arguments)


class Windows:
    """A model in windows of a drive, each of which starts from the measured state.

    Attributes
    ----------
    samples : array of int
        Indices of the m samples of each of w windows, shape (w, m).
    low, high : array
        Bounds of the p parameters of the model, shape (p,).
    """

    def __init__(self, model: Model, body: Body, drive: Drive, seconds: Spans, every: float = EVERY) -> None:
        self._arguments = model, body, drive
        self._steps = round(LENGTH / drive.interval)
        self._begins = begins(drive, seconds, every)
        self.samples = self._begins[:, None] + np.arange(self._steps + 1)
        self.low, self.high = (np.array([getattr(u, end) for u in model.unknowns]) for end in ("low", "high"))

    def simulated(self, numbers: Array) -> tuple[Array, Array]:
        """Lateral velocity, m/s, and yaw rate, rad/s, (k, w, m) each, for k sets of parameters, shape (k, p)."""
        model, body, drive = self._arguments
        return simulate_model(model, body, drive, self._begins, self._steps, numbers)

    def deviations(self, numbers: Array) -> tuple[Array, Array]:
        """Differences of `simulated` from the measurement."""
        vy, rate = self.simulated(numbers)
        return vy - self._arguments[2].vy[self.samples], rate - self._arguments[2].yaw_rate[self.samples]

    def errors(self, numbers: Array) -> Array:
        """Errors in `SCALES`, shape (k, n): of the yaw rate, then of the lateral velocity if the model has one."""
        across, turning = (e.reshape(len(e), -1) for e in self.deviations(numbers))
        turning = turning / SCALES[0]
        return np.asarray(np.hstack([turning, across / SCALES[1]]) if self._arguments[0].moves_across else turning)

    def residuals(self, p: Array) -> Array:
        """`errors` of one set of parameters, shape (n,); 1000 if the model diverges."""
        return np.nan_to_num(self.errors(p[None])[0], nan=1e3)

    def jacobian(self, p: Array) -> Array:
        """Derivatives of `errors` with respect to the parameters, shape (n, p)."""
        step = STEP * (self.high - self.low)
        side = np.where(p + step > self.high, -1.0, 1.0) * step
        e = self.errors(np.vstack([p, p + np.diag(side)]))
        return np.asarray(((e[1:] - e[0]) / side[:, None]).T)


def fit(model: Model, body: Body, drive: Drive, seconds: Spans = FITTED, others: Spans = JUDGED) -> Fitted:
    """Fit a model to the yaw rate, and lateral velocity if it has one, in the spans `seconds`; errors are in
    `others`.
    """
    windows, judged = (Windows(model, body, drive, spans) for spans in (seconds, others))
    low, high = windows.low, windows.high
    random, results = np.random.default_rng(SEED), []
    for _ in range(STARTS if len(low) else 0):
        start = low + (high - low) * random.uniform(0.2, 0.8, len(low))
        results.append(
            least_squares(
                windows.residuals,
                start,
                windows.jacobian,
                bounds=(low, high),
                x_scale=high - low,
                ftol=1e-6,
                max_nfev=60,
            )
        )
    numbers = min(results, key=lambda r: float(r.cost)).x if results else np.zeros(0)
    vy, rate = (states[0] for states in judged.simulated(numbers[None]))
    path = simulate_model(model, body, drive, np.array([0]), len(drive.time) - 1, numbers[None])[1][0, 0]
    turning = rate - drive.yaw_rate[judged.samples]
    return Fitted(
        model,
        numbers,
        [_rms(r.fun) for r in results],
        _rms(windows.deviations(numbers[None])[1]),
        _rms(turning),
        _rms((path - drive.yaw_rate)[drive.inside(others)]),
        _rms(vy - drive.vy[judged.samples]),
        int((np.abs(turning).max(axis=1) > np.ptp(drive.yaw_rate)).sum()),
        path,
        (vy, rate),
    )


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(np.square(values))))
