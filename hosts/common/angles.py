"""Difference of two angles modulo a full turn."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

# rad between neighbouring samples from which on a change is taken for a whole turn: a heading in a range of one turn
# jumps by nearly a turn, and an angle that is not wrapped, such as that of a steering wheel, rarely moves so far.
_JUMP = 1.5 * math.pi


def continuous(angle: ArrayLike) -> NDArray[np.float64]:
    """An angle over time without its jumps by whole turns.

    `angle`: rad, shape (n,); what is not finite stays, and the samples around it are taken as neighbours.
    """
    values = np.array(angle, dtype=np.float64)
    finite = np.isfinite(values)
    values[finite] = np.unwrap(values[finite], discont=_JUMP)
    return values


def angle_difference(first: ArrayLike, second: ArrayLike) -> NDArray[np.float64]:
    """The first angle less the second over time: without jumps, and within half a turn at its first finite sample.

    `first`, `second`: rad, shape (n,). That one of both has turned once more than the other in the meantime is told:
    whole turns are left out of the start only.
    """
    difference = continuous(np.subtract(first, second))
    start = difference[np.isfinite(difference)][:1]
    return np.asarray(difference - math.tau * np.round(start / math.tau)) if len(start) else difference
