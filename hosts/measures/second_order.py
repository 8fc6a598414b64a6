"""System of second order that is fitted to frequency responses."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from hosts.measures.frequency_response import FrequencyResponse


@dataclass(frozen=True)
class SecondOrder:
    """Response gain (1 + a s + b s²) / (1 + 2 zeta s / w + s² / w²)."""

    gain: float
    """Of the steady state, in units of output over input."""
    natural_frequency: float
    """w, rad/s, undamped."""
    damping_ratio: float
    """zeta."""
    lead: tuple[float, float]
    """a, s, and b, s²: the numerator."""
    misfit: float
    """RMS of the difference from the data over the RMS of the data."""

    def response(self, frequency: NDArray[np.float64]) -> NDArray[np.complex128]:
        """Response at frequencies in Hz."""
        s = 2j * math.pi * frequency
        a, b = self.lead
        w = self.natural_frequency
        return np.asarray(self.gain * (1 + a * s + b * s**2) / _denominator(s, w, self.damping_ratio))


NOTHING = SecondOrder(*3 * (math.nan,), (math.nan, math.nan), math.nan)


def fit_second_order(responses: Sequence[FrequencyResponse], zeros: Sequence[int]) -> list[SecondOrder]:
    """Fit one natural frequency and damping ratio to several responses, each with its own gain and numerator.

    `responses`: of one system, at four frequencies or more each; `zeros`: degrees of the numerators: 1 for the yaw rate
    and the sideslip angle of a bicycle model, 2 for its lateral acceleration, 0 for a mass on a spring. Returns one for
    each response; all NaN if it does not converge.

    Notes
    -----
    Least squares of the complex responses, each relative to its own size, weighted by the coherence; frequencies count
    by octaves. For a given denominator gains and numerators follow linearly, so two numbers are searched.
    """
    if not responses or any(len(r.frequency) < 4 or not np.abs(r.response).max() > 0.0 for r in responses):
        return [NOTHING] * len(responses)

    def numerators(p: NDArray[np.float64]) -> tuple[list[NDArray[np.float64]], NDArray[np.float64]]:
        results, off = [], []
        for r, n in zip(responses, zeros, strict=True):
            s = 2j * math.pi * r.frequency
            basis = np.stack([s**k for k in range(n + 1)], 1) / _denominator(s, math.exp(p[0]), p[1])[:, None]
            # lines of a geometric series are even in octaves; those of others count by their distance
            weight = np.sqrt(np.maximum(r.coherence, 0.0) * np.gradient(np.log(r.frequency)))
            weight = weight / math.sqrt(float(np.sum(np.abs(weight * r.response) ** 2)))
            a, b = weight[:, None] * basis, weight * r.response
            matrix, target = np.concatenate([a.real, a.imag]), np.concatenate([b.real, b.imag])
            scale = np.linalg.norm(matrix, axis=0)
            x = np.linalg.lstsq(matrix / scale, target, rcond=None)[0] / scale
            results.append(x)
            off.append(matrix @ x - target)
        return results, np.concatenate(off)

    def misfit(p: NDArray[np.float64]) -> NDArray[np.float64]:
        return numerators(p)[1]

    begins = [np.array([math.log(w), zeta]) for w in (2.0, 6.0, 20.0) for zeta in (0.3, 0.9)]
    solutions = [least_squares(misfit, x, bounds=([-3.0, 0.0], [7.0, 20.0])) for x in begins]
    best = min((t for t in solutions if t.success), key=lambda t: float(t.cost), default=None)
    if best is None:
        return [NOTHING] * len(responses)
    w, zeta = math.exp(best.x[0]), float(best.x[1])
    fits = []
    for r, x in zip(responses, numerators(best.x)[0], strict=True):
        lead = (*(float(c) for c in x[1:] / x[0]), 0.0, 0.0)
        fit = SecondOrder(float(x[0]), w, zeta, (lead[0], lead[1]), math.nan)
        off = fit.response(r.frequency) - r.response
        fits.append(replace(fit, misfit=math.sqrt(float(np.mean(np.abs(off) ** 2) / np.mean(np.abs(r.response) ** 2)))))
    return fits


def _denominator(s: NDArray[np.complexfloating], w: float, zeta: float) -> NDArray[np.complex128]:
    return np.asarray(1.0 + 2.0 * zeta * s / w + (s / w) ** 2)
