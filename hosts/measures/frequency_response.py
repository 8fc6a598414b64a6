"""Frequency response of one signal to another, with its coherence, by averaged periodograms."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import csd, welch


@dataclass(frozen=True)
class FrequencyResponse:
    """Response over frequency.

    Parameters
    ----------
    frequency : ndarray of shape (n,)
        Hz, increasing.
    response : ndarray of shape (n,), complex
        Output over input.
    coherence : ndarray of shape (n,)
        Part of the output's power that follows linearly from the input, 0 to 1.
    """

    frequency: NDArray[np.float64]
    response: NDArray[np.complex128]
    coherence: NDArray[np.float64]

    @property
    def gain(self) -> NDArray[np.float64]:
        """Magnitude, in units of output over input."""
        return np.abs(self.response)

    @property
    def phase(self) -> NDArray[np.float64]:
        """Phase without jumps, rad; negative: the output lags."""
        phase = np.unwrap(np.angle(self.response))
        # unwrapping begins at the lowest frequency, where the phase is small or a half turn
        return np.asarray(phase)

    def at(self, frequency: float) -> complex:
        """Response at a frequency, Hz, linear in gain and phase in between; NaN outside."""
        if not len(self.frequency) or not self.frequency[0] <= frequency <= self.frequency[-1]:
            return complex(float("nan"), float("nan"))
        gain = np.interp(frequency, self.frequency, self.gain)
        return complex(gain * np.exp(1j * np.interp(frequency, self.frequency, self.phase)))


def frequency_response(
    given: NDArray[np.float64],
    answer: NDArray[np.float64],
    interval: float,
    lowest: float,
    highest: float,
    window: float = 20.0,
) -> FrequencyResponse:
    """Estimate the response of `answer` to `given`.

    Parameters
    ----------
    given, answer : ndarray of shape (n,)
        Input and output at even times.
    interval : float
        Between samples, s.
    lowest, highest : float
        Range of frequencies that is wanted, Hz; the input must have power in it.
    window : float
        Length of the periodograms, s: many times the memory of the system. Its inverse is the resolution.

    Returns
    -------
    FrequencyResponse

    Raises
    ------
    ValueError
        If the record is shorter than two windows, or the range is not below half the sampling frequency.

    Notes
    -----
    H1 estimator of cross- over auto-spectrum, Hann windows that overlap by three quarters: noise of the output does not
    bias it. A coherence that is well below 1 says that the output has noise, or that the system is not linear.
    """
    length = round(window / interval)
    if len(given) != len(answer) or len(given) < 2 * length:
        have = len(given) * interval
        raise ValueError(f"A frequency response by windows of {window:g} s needs {2 * window:g} s; there are {have:g} s.")
    if not 0.0 < lowest < highest < 0.5 / interval:
        raise ValueError(f"Frequencies of {lowest:g} to {highest:g} Hz cannot be had from samples each {interval:g} s.")
    options = {"fs": 1.0 / interval, "window": "hann", "nperseg": length, "noverlap": length * 3 // 4}
    frequency, cross = csd(given, answer, detrend="constant", **options)
    power = welch(given, detrend="constant", **options)[1]
    other = welch(answer, detrend="constant", **options)[1]
    kept = (frequency >= lowest - 1e-9) & (frequency <= highest + 1e-9)
    coherence = np.abs(cross[kept]) ** 2 / np.maximum(power[kept] * other[kept], np.finfo(float).tiny)
    response = cross[kept] / np.maximum(power[kept], np.finfo(float).tiny)
    return FrequencyResponse(frequency[kept], response, np.minimum(coherence, 1.0))
