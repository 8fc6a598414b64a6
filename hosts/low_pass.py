"""Low-pass filter for recorded signals, as measured ones are filtered before they are compared."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.signal import butter, filtfilt


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
    if not 0.0 < frequency < 0.5 / interval:
        raise ValueError(
            f"A low-pass of {frequency:g} Hz needs samples closer than {0.5 / frequency:g} s, not {interval:g} s."
        )
    b, a = butter(2, 2.0 * frequency * interval)
    x = np.asarray(values, float)
    # ends are mirrored over a fixed time, so that the result does not depend on the sampling
    mirrored = min(len(x) - 1, round(3.0 / (frequency * interval)))
    return np.asarray(filtfilt(b, a, x, padlen=mirrored))
