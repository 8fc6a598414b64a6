"""Numbers that are read off a frequency response: bandwidths, resonance, equivalent time."""

import math
from dataclasses import dataclass

import numpy as np

from hosts.measures.filters import crossing
from hosts.measures.frequency_response import FrequencyResponse


@dataclass(frozen=True)
class Bandwidth:
    """NaN where the response does not show it in its range."""

    low_gain: float
    """Gain at the lowest frequency, in units of output over input."""
    gain_bandwidth: float
    """Where the gain has fallen to 1/sqrt(2) of it (-3 dB), Hz."""
    phase_bandwidth: float
    """Where the output lags by 45 degrees more than a response without delay, Hz."""
    equivalent_time: float
    """1 / (2 pi `phase_bandwidth`), s: time constant of the lag of first order with the same."""
    resonance: float
    """Where the gain is largest, Hz; NaN if that is at an end of the range."""
    resonance_ratio: float
    """Gain there over `low_gain`."""


def bandwidth(response: FrequencyResponse) -> Bandwidth:
    """Read the numbers off a response.

    `response`: over a range that begins where the response is still that of the steady state.

    Notes
    -----
    A response that turns the sign, as that of the sideslip angle or the roll angle may, counts its phase from the half
    turn. The phase at the lowest frequency is not subtracted.
    """
    if len(response.frequency) < 3:
        return Bandwidth(*6 * (math.nan,))
    gain, f = response.gain, response.frequency
    low = float(gain[0])
    phase = response.phase
    # whole half turns at the lowest frequency are a sign of the units, no delay
    phase = phase - math.pi * np.round(phase[0] / math.pi)
    lag = crossing(f, phase, -math.pi / 4)
    top = int(np.argmax(gain))
    inside = 0 < top < len(f) - 1
    return Bandwidth(
        low,
        crossing(f, gain, low / math.sqrt(2.0)),
        lag,
        1.0 / (2.0 * math.pi * lag),
        float(f[top]) if inside else math.nan,
        float(gain[top] / low) if inside else math.nan,
    )
