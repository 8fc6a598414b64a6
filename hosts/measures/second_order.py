"""System of second order that is fitted to a frequency response."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from hosts.measures.frequency_response import FrequencyResponse


@dataclass(frozen=True)
class SecondOrder:
    """Response gain (1 + a s + b s²) / (1 + 2 zeta s / w + s² / w²).

    Parameters
    ----------
    gain : float
        Of the steady state, in units of output over input.
    natural_frequency : float
        w, rad/s, undamped.
    damping_ratio : float
        zeta.
    lead : tuple of float
        a, s, and b, s²: the numerator.
    misfit : float
        RMS of the difference from the data over the RMS of the data.
    """

    gain: float
    natural_frequency: float
    damping_ratio: float
    lead: tuple[float, float]
    misfit: float

    def response(self, frequency: NDArray[np.float64]) -> NDArray[np.complex128]:
        """Response at frequencies in Hz."""
        s = 2j * math.pi * frequency
        a, b = self.lead
        w = self.natural_frequency
        return np.asarray(self.gain * (1 + a * s + b * s**2) / (1 + 2 * self.damping_ratio * s / w + (s / w) ** 2))


NOTHING = SecondOrder(*3 * (math.nan,), (math.nan, math.nan), math.nan)


def fit_second_order(response: FrequencyResponse, zeros: int) -> SecondOrder:
    """Fit by least squares of the complex response, weighted by the coherence.

    Parameters
    ----------
    response : FrequencyResponse
        At four frequencies or more.
    zeros : int
        Degree of the numerator: 1 for the yaw rate and the sideslip angle of a bicycle model, 2 for its lateral
        acceleration, 0 for a mass on a spring.

    Returns
    -------
    SecondOrder
        All NaN if it does not converge.
    """
    f, data = response.frequency, response.response
    if len(f) < 4 or not np.isfinite(data).all() or not np.abs(data).max() > 0.0:
        return NOTHING
    low = float(data[0].real) or float(np.abs(data[0]))
    # frequencies are spaced evenly: the factor 1/sqrt(f) gives each octave the same weight
    weight = np.sqrt(np.maximum(response.coherence, 0.0) / f) / math.sqrt(float(np.mean(np.abs(data) ** 2 / f)))

    def model(p: NDArray[np.float64]) -> SecondOrder:
        lead = (float(p[3]) if zeros > 0 else 0.0, float(p[4]) if zeros > 1 else 0.0)
        return SecondOrder(low * float(p[0]), math.exp(float(p[1])), float(p[2]), lead, math.nan)

    def misfit(p: NDArray[np.float64]) -> NDArray[np.float64]:
        off = weight * (model(p).response(f) - data)
        return np.concatenate([off.real, off.imag])

    best = None
    for begin in (3.0, 8.0, 20.0):
        start = [1.0, math.log(begin), 0.7, 0.1, 0.01][: 3 + zeros]
        found = least_squares(misfit, start, x_scale=[1.0, 0.5, 0.3, 0.1, 0.01][: 3 + zeros])
        if found.success and (best is None or found.cost < best.cost):
            best = found
    if best is None:
        return NOTHING
    made = model(best.x)
    off = made.response(f) - data
    rms = math.sqrt(float(np.mean(np.abs(off) ** 2) / np.mean(np.abs(data) ** 2)))
    return SecondOrder(made.gain, made.natural_frequency, abs(made.damping_ratio), made.lead, rms)
