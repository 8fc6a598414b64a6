"""Measures of a car that falls onto its wheels: contact, peak, time to settle, weight from momentum."""

import math

import numpy as np
from numpy.typing import NDArray

from hosts.measures.wheels import LIFTED


def weight_from_momentum(time: NDArray[np.float64], load: NDArray[np.float64]) -> float:
    """Weight of a car that rests vertically at the first and at the last sample.

    `time`, `load`: in s, sum of the normal forces of a level road in N, shape (n,). Result: in N. The momentum is zero
    at both ends, so the impulse of the road is that of gravity: the mean load is the weight, whatever happens in
    between and whatever the gravity.
    """
    return float(np.trapezoid(load, time) / (time[-1] - time[0]))


def first_contact(time: NDArray[np.float64], load: NDArray[np.float64]) -> float:
    """Time of the first sample with a load, s; NaN if there is none. The contact lies in the step before it."""
    touching = np.flatnonzero(load > LIFTED)
    return float(time[touching[0]]) if len(touching) else math.nan


def fall_time(height: float, gravity: float) -> float:
    """Time of free fall from rest, sqrt(2 h / g), s."""
    return math.sqrt(2.0 * max(height, 0.0) / gravity)


def settling_time(time: NDArray[np.float64], values: NDArray[np.float64], final: float, band: float) -> float:
    """When a signal enters a band around its final value for good.

    `time`, `values`: shape (n,); `final`, `band`: the band is `final` ± `band`. Result: in s, time of the first sample
    after the last one outside; NaN if the last sample is outside.
    """
    outside = np.flatnonzero(np.abs(values - final) > band)
    if not len(outside):
        return float(time[0])
    return float(time[outside[-1] + 1]) if outside[-1] + 1 < len(time) else math.nan


def rebound(height: NDArray[np.float64]) -> tuple[int, int]:
    """Where a body that has touched the ground is lowest first and, after that, highest. `height`: in m, shape (n,).

    Returns `lowest` and `highest`: samples; the lowest is the end of the first fall, the highest is that of all that
    follow.
    """
    rising = np.flatnonzero(np.diff(height) > 0.0)
    lowest = int(rising[0]) if len(rising) else len(height) - 1
    return lowest, lowest + int(np.argmax(height[lowest:]))
