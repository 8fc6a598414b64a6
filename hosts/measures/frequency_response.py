"""Frequency response of one signal to another by spectra averaged over bands, and measures of it."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import csd

from hosts.measures.filters import crossing

_RELATIVE_WIDTH = 0.03
"""Half width of the band over which spectra are averaged, relative to its frequency."""


@dataclass(frozen=True)
class FrequencyResponse:
    """Response of an output to an input by frequency, estimated from a run."""

    frequency: NDArray[np.float64]
    """Shape (n,): Hz, increasing."""
    response: NDArray[np.complex128]
    """Shape (n,): output over input."""
    coherence: NDArray[np.float64]
    """Shape (n,): fraction of the power of the output that is linear in the input, 0 to 1."""

    @property
    def gain(self) -> NDArray[np.float64]:
        """Magnitude, in units of output over input."""
        return np.abs(self.response)

    @property
    def phase(self) -> NDArray[np.float64]:
        """Phase without jumps, rad; negative: the output lags."""
        phase = np.unwrap(np.angle(self.response))
        # The phase of a negative gain begins near a half turn, on either side of it.
        return np.asarray(phase + (2.0 * np.pi if len(phase) and phase[0] < -0.5 * np.pi else 0.0))

    def phase_at(self, frequency: float) -> float:
        """Phase at a frequency in Hz, rad, by linear interpolation; NaN outside of the range."""
        if not len(self.frequency):
            return float("nan")
        return float(np.interp(frequency, self.frequency, self.phase, left=np.nan, right=np.nan))


def frequency_response(
    excitation: NDArray[np.float64],
    response_signal: NDArray[np.float64],
    interval: float,
    frequency: NDArray[np.float64],
) -> FrequencyResponse:
    """Estimate the response of `response_signal` to `excitation` from one record that begins and ends at rest.

    Parameters
    ----------
    excitation, answer : ndarray of shape (n,)
        Input and output at even times, minus their values at rest.
    interval : float
        Between samples, s.
    frequency : ndarray of shape (m,)
        At which the response is wanted, Hz, increasing; the input must have power there.

    Raises
    ------
    ValueError
        If the record has less than three periods of the lowest frequency, or the highest is not below half the sampling
        frequency.

    Notes
    -----
    H1 estimator: averaged cross-spectrum over averaged auto-spectrum of the input, which noise of the output does not
    bias. The spectra are those of the whole record without a window, which is exact for a linear system at rest at both
    ends; windowed segments would separate the response from its excitation. A coherence well below 1 shows noise of the
    output, or a nonlinear system.
    """
    duration = len(excitation) * interval
    if len(excitation) != len(response_signal) or duration * frequency[0] < 3.0:
        raise ValueError(
            f"A response at {frequency[0]:g} Hz needs a record of {3.0 / frequency[0]:.3g} s, not {duration:.3g} s."
        )
    if not 0.0 < frequency[0] <= frequency[-1] < 0.5 / interval:
        raise ValueError(
            f"Responses at {frequency[0]:g} to {frequency[-1]:g} Hz cannot be obtained from samples each {interval:g} "
            "s."
        )
    # Zeros after the record make the spacing of lines smaller than the bands.
    padded = 4 * len(excitation)

    def spectrum(x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.complexfloating]:
        return np.asarray(csd(x, y, fs=1.0 / interval, window="boxcar", nperseg=len(x), nfft=padded, detrend=False)[1])

    lines = np.fft.rfftfreq(padded, interval)
    cross_power = spectrum(excitation, response_signal)
    input_power, output_power = spectrum(excitation, excitation), spectrum(response_signal, response_signal)
    tiny = np.finfo(float).tiny
    response, coherence = np.empty(len(frequency), complex), np.empty(len(frequency))
    for k, f in enumerate(frequency):
        width = max(_RELATIVE_WIDTH * f, 3.0 / duration)
        band = slice(*np.searchsorted(lines, (f - width, f + width)))
        weights = 1.0 + np.cos(np.pi * (lines[band] - f) / width)
        sxy, sxx, syy = (complex(weights @ x[band]) for x in (cross_power, input_power, output_power))
        response[k] = sxy / max(sxx.real, tiny)
        coherence[k] = min(abs(sxy) ** 2 / max(sxx.real * syy.real, tiny), 1.0)
    return FrequencyResponse(np.asarray(frequency, float), response, coherence)


@dataclass(frozen=True)
class Bandwidth:
    """Measures of a frequency response; NaN if they are not in its range."""

    low_gain: float = math.nan
    """Gain at the lowest frequency, in units of output per input."""
    gain_bandwidth: float = math.nan
    """Frequency at which the gain is `low_gain` / sqrt(2) (-3 dB), Hz."""
    phase_bandwidth: float = math.nan
    """Frequency at which the phase lag is 45 degrees, Hz."""
    equivalent_time: float = math.nan
    """1 / (2 pi `phase_bandwidth`), s: time constant of the first-order lag with that phase bandwidth."""
    resonance: float = math.nan
    """Frequency of the largest gain, Hz; NaN if that is at an end of the range."""
    resonance_ratio: float = math.nan
    """Gain at the resonance divided by `low_gain`."""


def bandwidth(response: FrequencyResponse) -> Bandwidth:
    """Measures of a frequency response.

    `response`: its lowest frequency is low enough for the steady-state response.

    Notes
    -----
    The phase of a response with a negative steady-state gain, as of the sideslip or the roll angle, is counted from a
    half turn. The phase at the lowest frequency is not subtracted.
    """
    if len(response.frequency) < 3:
        return Bandwidth()
    gain, f = response.gain, response.frequency
    low_gain = float(gain[0])
    phase = response.phase
    # Half turns at the lowest frequency are a negative gain, not a delay.
    phase = phase - math.pi * np.round(phase[0] / math.pi)
    phase_bandwidth = crossing(f, phase, -math.pi / 4)
    peak = int(np.argmax(gain))
    inside = 0 < peak < len(f) - 1
    return Bandwidth(
        low_gain=low_gain,
        gain_bandwidth=crossing(f, gain, low_gain / math.sqrt(2.0)),
        phase_bandwidth=phase_bandwidth,
        equivalent_time=1.0 / (2.0 * math.pi * phase_bandwidth),
        resonance=float(f[peak]) if inside else math.nan,
        resonance_ratio=float(gain[peak] / low_gain) if inside else math.nan,
    )
