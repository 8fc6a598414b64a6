"""Steering wheel angle for a lateral acceleration, from a run in which it grows slowly."""

import math

import numpy as np
from numpy.typing import NDArray

G = 9.80665
_WANTED = 0.3 * G
_LOWEST = 0.1 * G
_HIGHEST = 0.375 * G


def angle_by_regression(steering: NDArray[np.float64], acceleration: NDArray[np.float64]) -> float:
    """Angle at a lateral acceleration of 0.3 g, from a straight line through the run from 0.1 g to 0.375 g.

    `steering`, `acceleration`: in rad and m/s², of one turn, shape (n,); both of one sign, or both of the other.
    Returns size of the angle, rad; NaN if the run does not reach 0.375 g.
    """
    size = np.abs(acceleration)
    if not (size >= _HIGHEST).any():
        return math.nan
    last = int(np.argmax(size >= _HIGHEST))
    first = int(np.argmax(size >= _LOWEST))
    if last - first < 3:
        return math.nan
    line = np.polyfit(size[first:last], np.abs(steering[first:last]), 1)
    return float(np.polyval(line, _WANTED))
