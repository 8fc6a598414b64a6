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
    """A simulated signal between its points, and its slope there; a cubic spline, at the ends it stays as it is.

    `end`: in s; it begins at 0. Runs that were put one after the other have a spline each.
    """

    def __init__(self, result: Result, name: str) -> None:
        values = result.continuous(name)
        self._angle = result.units.get(name) == "rad"
        self.end = float(result.time[-1])
        slices = [slice(a, b) for a, b in pairwise([*result.starts, len(values)])]
        self._parts = [_Part(result.time[part], values[part]) for part in slices]
        # Between two runs the earlier one holds up to the middle.
        self._edges = np.array([0.5 * (a.end + b.begin) for a, b in pairwise(self._parts)])

    def __call__(self, t: NDArray[np.float64]) -> NDArray[np.float64]:
        """Values at times in s."""
        return self._of(t, 0)

    def slope(self, t: NDArray[np.float64]) -> NDArray[np.float64]:
        """Derivative by the time at times in s."""
        return self._of(t, 1)

    def misfit(self, signal: Signal) -> NDArray[np.float64]:
        """Simulated minus measured at the samples of a signal; of angles as `angle_difference` says, in each run."""
        simulated = self(signal.time)
        if not self._angle:
            return np.asarray(simulated - signal.values)
        results, number = np.empty(len(simulated)), self._run_of(signal.time)
        for k in np.unique(number):
            results[number == k] = angle_difference(simulated[number == k], signal.values[number == k])
        return results

    def in_its_turns(self, signal: Signal) -> Signal:
        """A measured signal, of an angle that which is whole turns away and nearest to the simulated one."""
        if not self._angle:
            return signal
        return replace(signal, values=self(signal.time) - self.misfit(signal))

    def _run_of(self, t: NDArray[np.float64]) -> NDArray[np.int64]:
        return np.searchsorted(self._edges, t)

    def _of(self, t: NDArray[np.float64], order: int) -> NDArray[np.float64]:
        if len(self._parts) == 1:
            return self._parts[0](t, order)
        results, number = np.empty(len(t)), self._run_of(t)
        for k in np.unique(number).tolist():
            results[number == k] = self._parts[k](t[number == k], order)
        return results


class _Part:
    """A run between its points."""

    def __init__(self, time: NDArray[np.float64], values: NDArray[np.float64]) -> None:
        self.begin, self.end = float(time[0]), float(time[-1])
        # Four points are the fewest of a spline whose ends have no condition.
        self._spline = CubicSpline(time, values) if len(values) > 3 else None
        self._few = (time, values)

    def __call__(self, t: NDArray[np.float64], order: int) -> NDArray[np.float64]:
        if self._spline is None:
            return np.zeros(len(t)) if order else np.interp(t, *self._few)
        inside = (t >= self.begin) & (t <= self.end)
        result = self._spline(np.clip(t, self.begin, self.end), order)
        return np.asarray(np.where(inside, result, 0.0) if order else result)


class SensedCurve(Curve):
    """A simulated signal as a sensor gives it: bias + gain * simulated((t - delay) / (1 + drift)).

    `delay`, `drift`, `bias`, `gain`: s; the unit of the signal.
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
        """Derivative by the time at times in s."""
        return np.asarray(self._gain / self._stretch * self._curve.slope((t - self._delay) / self._stretch))

    def _run_of(self, t: NDArray[np.float64]) -> NDArray[np.int64]:
        return self._curve._run_of((t - self._delay) / self._stretch)
