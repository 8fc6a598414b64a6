"""Difference of two angles modulo a full turn."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

# Least change between samples that is taken for a wrap, rad: a wrapped heading jumps by nearly a turn, and an angle
# that is not wrapped, such as that of a steering wheel, rarely changes so much.
_JUMP = 1.5 * math.pi


def continuous(angle: ArrayLike) -> NDArray[np.float64]:
    """An angle over time without its jumps by whole turns.

    `angle`: rad, shape (n,); values that are not finite remain, and the samples around them are taken as neighbours.
    """
    values = np.array(angle, dtype=np.float64)
    finite = np.isfinite(values)
    values[finite] = np.unwrap(values[finite], discont=_JUMP)
    return values


def angle_difference(first: ArrayLike, second: ArrayLike) -> NDArray[np.float64]:
    """The first angle less the second over time: without jumps, and within half a turn at its first finite sample.

    `first`, `second`: rad, shape (n,). Only whole turns at the start are removed, so that a turn that only one of them
    makes afterwards remains.
    """
    difference = continuous(np.subtract(first, second))
    start = difference[np.isfinite(difference)][:1]
    return np.asarray(difference - math.tau * np.round(start / math.tau)) if len(start) else difference
