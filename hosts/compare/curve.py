"""Simulated signals at the times of measured samples."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from hosts.driving.co_simulation import Result


class Curve:
    """A simulated signal between its points, and its slope there; a cubic spline, at the ends it stays as it is.

    Attributes
    ----------
    end : float
        s; it begins at 0.
    """

    def __init__(self, result: Result, name: str) -> None:
        values = result[name]
        self.end = float(result.time[-1])
        # Four points are the fewest of a spline whose ends have no condition.
        self._spline = CubicSpline(result.time, values) if len(values) > 3 else None
        self._few = (result.time, values)

    def __call__(self, t: NDArray[np.float64]) -> NDArray[np.float64]:
        """Values at times in s."""
        if self._spline is None:
            return np.interp(t, *self._few)
        return np.asarray(self._spline(np.clip(t, 0.0, self.end)))

    def slope(self, t: NDArray[np.float64]) -> NDArray[np.float64]:
        """Derivative by the time at times in s."""
        if self._spline is None:
            return np.zeros(len(t))
        return np.asarray(np.where((t >= 0.0) & (t <= self.end), self._spline(np.clip(t, 0.0, self.end), 1), 0.0))


class SensedCurve(Curve):
    """A simulated signal as a sensor gives it: bias + gain * simulated((t - delay) / (1 + drift)).

    Parameters
    ----------
    delay, drift, bias, gain : float
        s; the unit of the signal.
    """

    def __init__(
        self, curve: Curve, delay: float = 0.0, drift: float = 0.0, bias: float = 0.0, gain: float = 1.0
    ) -> None:
        self._curve, self._delay, self._stretch, self._bias, self._gain = curve, delay, 1.0 + drift, bias, gain
        self.end = delay + self._stretch * curve.end

    def __call__(self, t: NDArray[np.float64]) -> NDArray[np.float64]:
        """Values at times in s."""
        return np.asarray(self._bias + self._gain * self._curve((t - self._delay) / self._stretch))

    def slope(self, t: NDArray[np.float64]) -> NDArray[np.float64]:
        """Derivative by the time at times in s."""
        return np.asarray(self._gain / self._stretch * self._curve.slope((t - self._delay) / self._stretch))
