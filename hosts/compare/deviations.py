"""Deviations between a simulated and a measured signal."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

_ROUNDING = 1e-9  # in the unit of a signal: below the resolution of any sensor


@dataclass(frozen=True)
class Deviations:
    """Deviations of a signal: simulated minus measured."""

    rms: float
    """Root of the mean square."""
    normalised: float
    """`rms` divided by the standard deviation of the measured signal: 0 if equal, 1 for the mean of the measured
    signal. NaN if the measured signal is constant."""
    mean: float
    """Mean deviation, in the unit of the signal."""
    largest: float
    """Largest deviation with its sign, in the unit of the signal."""
    time_of_largest: float
    """Time of the largest deviation, s."""
    correlation: float
    """Pearson's coefficient; NaN if one of both is constant."""
    samples: int
    note: str = ""
    """Why a number is NaN, otherwise empty."""


def deviations(time: ArrayLike, measured: ArrayLike, simulated: ArrayLike) -> Deviations:
    """Deviations of a signal. `time`: s; `measured`, `simulated`: values in the unit of the signal, shape (n,)."""
    t, y, x = (np.asarray(a, float) for a in (time, measured, simulated))
    error = x - y
    k = int(np.argmax(np.abs(error)))
    constant = [label for label, a in (("measured", y), ("simulated", x)) if is_constant(a)]
    correlation = math.nan if constant else float(np.corrcoef(x, y)[0, 1])
    size = rms(error)
    normalised = math.nan if "measured" in constant else size / float(np.std(y))
    note = f"the {' and the '.join(constant)} signal is constant: no correlation" if constant else ""
    return Deviations(size, normalised, float(np.mean(error)), float(error[k]), float(t[k]), correlation, len(y), note)


def rms(values: NDArray[np.float64]) -> float:
    """Root of the mean square."""
    return float(np.sqrt(np.mean(values**2)))


def is_constant(values: NDArray[np.float64]) -> bool:
    """Whether a signal varies by no more than rounding errors.

    Notes
    -----
    A car on a straight line has lateral accelerations of 1e-11 m/s2, which differ between runs.
    """
    return bool(np.ptp(values) <= max(1e-12 * float(np.max(np.abs(values))), _ROUNDING))
