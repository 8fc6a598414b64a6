"""A second-order system fitted to frequency responses."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from hosts.measures.frequency_response import FrequencyResponse


@dataclass(frozen=True)
class SecondOrder:
    """The response gain (1 + a s + b s²) / (1 + 2 zeta s / w + s² / w²)."""

    gain: float = math.nan
    """Steady-state gain, in units of output per input."""
    natural_frequency: float = math.nan
    """w, undamped, rad/s."""
    damping_ratio: float = math.nan
    """zeta."""
    lead: tuple[float, float] = (math.nan, math.nan)
    """a in s and b in s² of the numerator."""
    misfit: float = math.nan
    """RMS of fit minus data, divided by the RMS of the data."""

    def response(self, frequency: NDArray[np.float64]) -> NDArray[np.complex128]:
        """Response at frequencies in Hz."""
        s = 2j * math.pi * frequency
        a, b = self.lead
        w = self.natural_frequency
        return np.asarray(self.gain * (1 + a * s + b * s**2) / _denominator(s, w, self.damping_ratio))


def fit_second_order(responses: Sequence[FrequencyResponse], zeros: Sequence[int]) -> list[SecondOrder]:
    """Fit one natural frequency and damping ratio to several responses, each with its own gain and numerator.

    `responses`: responses of one system, at four frequencies or more each; `zeros`: degrees of the numerators: 1 for
    the yaw rate and the sideslip angle of a bicycle model, 2 for its lateral acceleration, 0 for a mass on a spring.
    Returns a fit for each response; all NaN if the search does not converge.

    Notes
    -----
    Least squares of the complex responses, each relative to its size, weighted by the coherence and by octaves. For a
    given denominator gains and numerators are linear unknowns, so that only w and zeta are searched.
    """
    if not responses or any(len(r.frequency) < 4 or not np.abs(r.response).max() > 0.0 for r in responses):
        return [SecondOrder()] * len(responses)

    def numerators(p: NDArray[np.float64]) -> tuple[list[NDArray[np.float64]], NDArray[np.float64]]:
        results, misfits = [], []
        for r, n in zip(responses, zeros, strict=True):
            s = 2j * math.pi * r.frequency
            basis = np.stack([s**k for k in range(n + 1)], 1) / _denominator(s, math.exp(p[0]), p[1])[:, None]
            # The weight of a frequency is its fraction of the octaves.
            weight = np.sqrt(np.maximum(r.coherence, 0.0) * np.gradient(np.log(r.frequency)))
            weight = weight / math.sqrt(float(np.sum(np.abs(weight * r.response) ** 2)))
            a, b = weight[:, None] * basis, weight * r.response
            matrix, target = np.concatenate([a.real, a.imag]), np.concatenate([b.real, b.imag])
            scale = np.linalg.norm(matrix, axis=0)
            x = np.linalg.lstsq(matrix / scale, target, rcond=None)[0] / scale
            results.append(x)
            misfits.append(matrix @ x - target)
        return results, np.concatenate(misfits)

    def misfit(p: NDArray[np.float64]) -> NDArray[np.float64]:
        return numerators(p)[1]

    start_points = [np.array([math.log(w), zeta]) for w in (2.0, 6.0, 20.0) for zeta in (0.3, 0.9)]
    solutions = [least_squares(misfit, x, bounds=([-3.0, 0.0], [7.0, 20.0])) for x in start_points]
    best = min((t for t in solutions if t.success), key=lambda t: float(t.cost), default=None)
    if best is None:
        return [SecondOrder()] * len(responses)
    w, zeta = math.exp(best.x[0]), float(best.x[1])
    fits = []
    for r, x in zip(responses, numerators(best.x)[0], strict=True):
        lead = (*(float(c) for c in x[1:] / x[0]), 0.0, 0.0)
        fit = SecondOrder(float(x[0]), w, zeta, (lead[0], lead[1]), math.nan)
        misfits = fit.response(r.frequency) - r.response
        fits.append(
            replace(fit, misfit=math.sqrt(float(np.mean(np.abs(misfits) ** 2) / np.mean(np.abs(r.response) ** 2))))
        )
    return fits


def _denominator(s: NDArray[np.complexfloating], w: float, zeta: float) -> NDArray[np.complex128]:
    return np.asarray(1.0 + 2.0 * zeta * s / w + (s / w) ** 2)
