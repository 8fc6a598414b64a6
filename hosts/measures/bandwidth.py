"""Measures of a frequency response: bandwidths, resonance, equivalent time."""

import math
from dataclasses import dataclass

import numpy as np

from hosts.measures.filters import crossing
from hosts.measures.frequency_response import FrequencyResponse


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
