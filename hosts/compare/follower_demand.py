"""The demand that makes a critically damped follower move as measured."""

import math

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from hosts.measures.signal import Signal


def follower_demand(signal: Signal, frequency: float, time: NDArray[np.float64]) -> NDArray[np.float64]:
    """The demand of a critically damped follower that moves as measured.

    `frequency`: frequency of the follower, Hz; `time`: s, shape (n,). Returns an array of shape (n,): x + 2 x' / w +
    x'' / w^2 with w = 2 pi frequency, of a cubic through the samples that has no extremes of its own. It begins with x,
    where the follower begins at rest; beyond the samples their ends are held.
    """
    w = 2.0 * math.pi * frequency
    x = PchipInterpolator(signal.time, signal.values)
    at = np.clip(time, signal.time[0], signal.time[-1])
    inside = (time > signal.time[0]) & (time < signal.time[-1])
    return np.asarray(x(at) + inside * (2.0 / w * x(at, 1) + x(at, 2) / w**2))
