"""The steering-wheel angle at a lateral acceleration, from a run with slowly increasing steer."""

import math

import numpy as np
from numpy.typing import NDArray

G = 9.80665  # m/s2
_TARGET = 0.3 * G
_MIN_ACCELERATION = 0.1 * G
_MAX_ACCELERATION = 0.375 * G


def angle_by_regression(steering: NDArray[np.float64], acceleration: NDArray[np.float64]) -> float:
    """Absolute angle at a lateral acceleration of 0.3 g, rad, by a regression line from 0.1 g to 0.375 g.

    `steering`, `acceleration`: rad and m/s², of a turn to one side, shape (n,). NaN if 0.375 g is not reached.
    """
    lateral = np.abs(acceleration)
    if not (lateral >= _MAX_ACCELERATION).any():
        return math.nan
    last = int(np.argmax(lateral >= _MAX_ACCELERATION))
    first = int(np.argmax(lateral >= _MIN_ACCELERATION))
    if last - first < 3:
        return math.nan
    line = np.polyfit(lateral[first:last], np.abs(steering[first:last]), 1)
    return float(np.polyval(line, _TARGET))
