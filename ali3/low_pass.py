"""Zero-phase low-pass filters for recorded signals."""

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.signal import butter, sosfiltfilt


def phaseless_low_pass(values: ArrayLike, interval: float, frequency: float, poles: int = 12) -> NDArray[np.float64]:
    """Apply a Butterworth filter forward and backward, which shifts nothing in time.

    Parameters
    ----------
    values : array_like, shape (n,)
        Samples at equal time intervals.
    interval : float
        Sampling interval, s.
    frequency : float
        Cut-off of each direction, Hz.
    poles : int
        Number of poles of both directions together, even; 12 in 49 CFR 571.126.

    Returns
    -------
    ndarray of shape (n,)
        Filtered samples.

    Raises
    ------
    ValueError
        The sampling frequency is too low for the cut-off, or the number of poles is odd.

    Notes
    -----
    A "12-pole phaseless" filter is interpreted as six poles in each direction. Both directions together leave 1/2 of
    the amplitude (-6 dB) at the cut-off, not 1/sqrt(2). The signal is continued by its mirror image through each end
    point over three periods of the cut-off, or over its length if that is shorter.
    """
    if not 0.0 < frequency < 0.5 / interval:
        raise ValueError(
            f"A low-pass of {frequency:g} Hz needs samples closer than {0.5 / frequency:g} s, not {interval:g} s."
        )
    if poles < 2 or poles % 2:
        raise ValueError(f"A phaseless filter has an even number of poles, not {poles}.")
    x = np.asarray(values, float)
    sections = butter(poles // 2, frequency, fs=1.0 / interval, output="sos")
    pad_length = min(len(x) - 1, round(3.0 / (frequency * interval)))
    return np.asarray(sosfiltfilt(sections, x, padtype="odd", padlen=pad_length))


def low_pass(values: ArrayLike, interval: float, frequency: float = 10.0) -> NDArray[np.float64]:
    """Apply a Butterworth filter of second order forward and backward, as for measured signals before a comparison.

    `values`: shape (n,); `interval`: sampling interval, s; `frequency`: cut-off at half of the power in each direction,
    below half the sampling frequency, Hz.
    """
    return phaseless_low_pass(values, interval, frequency, poles=4)
