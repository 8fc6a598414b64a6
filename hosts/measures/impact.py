"""Measures of a car that falls onto its wheels: contact, rebound, settling time, weight from momentum."""

import math

import numpy as np
from numpy.typing import NDArray

from hosts.measures.wheels import LIFTED


def weight_from_momentum(time: NDArray[np.float64], load: NDArray[np.float64]) -> float:
    """Weight of a car that rests vertically at the first and at the last sample.

    `time`, `load`: s, sum of the normal forces of a level road in N, shape (n,). Returns the weight, N.

    Notes
    -----
    The momentum is zero at both ends, so that the impulses of the road and of gravity are equal: the mean load is the
    weight.
    """
    return float(np.trapezoid(load, time) / (time[-1] - time[0]))


def first_contact(time: NDArray[np.float64], load: NDArray[np.float64]) -> float:
    """Time of the first sample with a load, s; NaN if there is none. The contact occurs in the step before it."""
    touching = np.flatnonzero(load > LIFTED)
    return float(time[touching[0]]) if len(touching) else math.nan


def fall_time(height: float, gravity: float) -> float:
    """Time of free fall from rest, sqrt(2 h / g), s."""
    return math.sqrt(2.0 * max(height, 0.0) / gravity)


def settling_time(time: NDArray[np.float64], values: NDArray[np.float64], final: float, band: float) -> float:
    """Time from which a signal stays within `final` ± `band`, s; NaN if the last sample is outside.

    `time`, `values`: shape (n,). The time is that of the first sample after the last one outside.
    """
    outside = np.flatnonzero(np.abs(values - final) > band)
    if not len(outside):
        return float(time[0])
    return float(time[outside[-1] + 1]) if outside[-1] + 1 < len(time) else math.nan


def rebound(height: NDArray[np.float64]) -> tuple[int, int]:
    """Samples of the end of the first fall and of the largest height after it. `height`: m, shape (n,)."""
    rising = np.flatnonzero(np.diff(height) > 0.0)
    lowest = int(rising[0]) if len(rising) else len(height) - 1
    return lowest, lowest + int(np.argmax(height[lowest:]))
