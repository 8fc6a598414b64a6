"""Zero-phase low-pass filters for recorded signals."""

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.signal import butter, sosfiltfilt


def phaseless_low_pass(values: ArrayLike, interval: float, frequency: float, poles: int = 12) -> NDArray[np.float64]:
    """Butterworth filter forward and back, so that nothing is shifted in time.

    Parameters
    ----------
    values : array_like, shape (n,)
        At even times.
    interval : float
        Between samples, s.
    frequency : float
        Cut-off of each direction, Hz: both together leave half of the amplitude there.
    poles : int
        Of both directions together, even; 12 as in 49 CFR 571.126.

    Returns
    -------
    ndarray of shape (n,)
        Ends are mirrored through the end point over three periods of the cut-off, as far as the signal is long enough.

    Raises
    ------
    ValueError
        If samples are too far apart for the cut-off, or poles are odd.

    Notes
    -----
    A "12-pole phaseless" filter is read as six poles in each direction. Its square of six poles at the same frequency
    leaves 1/2 of the amplitude (-6 dB) at the cut-off, not 1/sqrt(2).
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
    """Butterworth filter of second order, forward and back, as measured signals are filtered before they are compared.

    `values`: shape (n,); `interval`: time between samples, s; `frequency`: where half of the power is left in each
    direction, Hz; below half the sampling frequency.
    """
    return phaseless_low_pass(values, interval, frequency, poles=4)
