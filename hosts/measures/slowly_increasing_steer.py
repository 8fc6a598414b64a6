"""Steering wheel angle for a lateral acceleration, from a run in which it grows slowly."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

G = 9.80665


def angle_by_regression(
    steering: NDArray[np.float64],
    acceleration: NDArray[np.float64],
    wanted: float = 0.3 * G,
    lowest: float = 0.1 * G,
    highest: float = 0.375 * G,
) -> float:
    """Angle at a lateral acceleration, from a straight line through a part of the run.

    `steering`, `acceleration`: in rad and m/s², of one turn, shape (n,); both of one sign, or both of the other;
    `wanted`: m/s²; `lowest`, `highest`: sizes of the lateral acceleration between which the line is fitted, m/s²: from
    the first sample that is reached to the one before the first beyond. Returns size of the angle, rad; NaN if the run
    does not reach `highest`.
    """
    size = np.abs(acceleration)
    if not (size >= highest).any():
        return math.nan
    last = int(np.argmax(size >= highest))
    first = int(np.argmax(size >= lowest))
    if last - first < 3:
        return math.nan
    line = np.polyfit(size[first:last], np.abs(steering[first:last]), 1)
    return float(np.polyval(line, wanted))
