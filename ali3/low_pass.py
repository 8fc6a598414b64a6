"""Low-pass filter for recorded signals, as measured ones are filtered before they are compared."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hosts.measures.filters import phaseless_low_pass


def low_pass(values: ArrayLike, interval: float, frequency: float = 10.0) -> NDArray[np.float64]:
    """Butterworth filter of second order, forward and back, so that nothing is shifted in time.

    Parameters
    ----------
    values : array_like, shape (n,)
    interval : float
        Time between samples, s.
    frequency : float
        Where half of the power is left in each direction, Hz; below half the sampling frequency.
    """
    return phaseless_low_pass(values, interval, frequency, poles=4)
