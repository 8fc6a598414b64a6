"""Simulated signals at the times of measured samples."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from hosts.common.angles import angle_difference
from hosts.driving.result import Result
from hosts.measures.signal import Signal


class Curve:
    """A simulated signal as a cubic spline of each run, constant beyond the ends of a run.

    `end`: last time, s.
    """

    def __init__(self, result: Result, name: str) -> None:
        values = result.continuous(name)
        self._angle = result.units.get(name) == "rad"
        self.end = float(result.time[-1])
        slices = [slice(a, b) for a, b in pairwise([*result.starts, len(values)])]
        self._runs = [_RunCurve(result.time[rows], values[rows]) for rows in slices]
        # The gap between two runs is divided in its middle.
        self._edges = np.array([0.5 * (a.end + b.begin) for a, b in pairwise(self._runs)])

    def __call__(self, t: NDArray[np.float64]) -> NDArray[np.float64]:
        """Values at times in s."""
        return self._evaluate(t, 0)

    def slope(self, t: NDArray[np.float64]) -> NDArray[np.float64]:
        """Derivative with respect to time at times in s."""
        return self._evaluate(t, 1)

    def misfit(self, signal: Signal) -> NDArray[np.float64]:
        """Simulated minus measured at the samples of a signal, shape (n,); of angles by `angle_difference`."""
        simulated = self(signal.time)
        if not self._angle:
            return np.asarray(simulated - signal.values)
        results, run_numbers = np.empty(len(simulated)), self._run_numbers(signal.time)
        for k in np.unique(run_numbers):
            results[run_numbers == k] = angle_difference(simulated[run_numbers == k], signal.values[run_numbers == k])
        return results

    def with_nearest_turns(self, signal: Signal) -> Signal:
        """The measured signal, an angle shifted by whole turns to be nearest to the simulated one."""
        if not self._angle:
            return signal
        return replace(signal, values=self(signal.time) - self.misfit(signal))

    def _run_numbers(self, t: NDArray[np.float64]) -> NDArray[np.int64]:
        return np.searchsorted(self._edges, t)

    def _evaluate(self, t: NDArray[np.float64], order: int) -> NDArray[np.float64]:
        if len(self._runs) == 1:
            return self._runs[0](t, order)
        results, run_numbers = np.empty(len(t)), self._run_numbers(t)
        for k in np.unique(run_numbers).tolist():
            results[run_numbers == k] = self._runs[k](t[run_numbers == k], order)
        return results


class _RunCurve:
    """A signal of one run as a cubic spline, linear if it has fewer than four points."""

    def __init__(self, time: NDArray[np.float64], values: NDArray[np.float64]) -> None:
        self.begin, self.end = float(time[0]), float(time[-1])
        # Without conditions at its ends a spline needs four points.
        self._spline = CubicSpline(time, values) if len(values) > 3 else None
        self._samples = (time, values)

    def __call__(self, t: NDArray[np.float64], order: int) -> NDArray[np.float64]:
        if self._spline is None:
            return np.zeros(len(t)) if order else np.interp(t, *self._samples)
        inside = (t >= self.begin) & (t <= self.end)
        result = self._spline(np.clip(t, self.begin, self.end), order)
        return np.asarray(np.where(inside, result, 0.0) if order else result)


class SensedCurve(Curve):
    """A simulated signal as a sensor yields it: bias + gain * simulated((t - delay) / (1 + drift)).

    `delay`: of the sensor, s; `drift`: by how much its clock runs fast, relative; `bias`: offset in the unit of the
    signal; `gain`: factor of the signal.
    """

    def __init__(
        self, curve: Curve, delay: float = 0.0, drift: float = 0.0, bias: float = 0.0, gain: float = 1.0
    ) -> None:
        self._curve, self._delay, self._stretch, self._bias, self._gain = curve, delay, 1.0 + drift, bias, gain
        self._angle = curve._angle
        self.end = delay + self._stretch * curve.end

    def __call__(self, t: NDArray[np.float64]) -> NDArray[np.float64]:
        """Values at times in s."""
        return np.asarray(self._bias + self._gain * self._curve((t - self._delay) / self._stretch))

    def slope(self, t: NDArray[np.float64]) -> NDArray[np.float64]:
        """Derivative with respect to time at times in s."""
        return np.asarray(self._gain / self._stretch * self._curve.slope((t - self._delay) / self._stretch))

    def _run_numbers(self, t: NDArray[np.float64]) -> NDArray[np.int64]:
        return self._curve._run_numbers((t - self._delay) / self._stretch)
