"""Noise of measured and of simulated signals."""

import numpy as np
from numpy.typing import NDArray

from hosts.compare.deviations import rms
from hosts.compare.residuals import Residuals

_POINTS = 5
_ORDER = 4
_NARROW = 1e-7  # of a range, over which residuals are linear except for noise
_PROBE = 0.01
_MIN_STEP = 1e-5
_MAX_STEP = 0.02


def measured_noise(values: NDArray[np.float64]) -> float:
    """Standard deviation of the white noise of a signal that is smooth at its sampling rate.

    `values`: shape (n,).

    Notes ----- From the median of third differences, which remove the smooth part; their variance is 20 times the
    variance of the noise.
    """
    third = np.diff(values, 3)
    return float(np.median(np.abs(third)) / 0.6744897501960817 / np.sqrt(20.0))


def computed_noise(residuals: Residuals, p: NDArray[np.float64]) -> float:
    """Root mean square of the noise of the residuals by iterations and rounding of the FMU.

    `p`: shape (p,).

    Notes
    -----
    From the table of differences over closely spaced points (Moré and Wild: Estimating computational noise, SIAM J.
    Sci. Comput. 33, 2011); the variance of fourth differences is 70 times that of the noise.
    """
    direction = np.array([u.high - u.low if u.kind == "parameter" else 0.0 for u in residuals.unknowns])
    # The points lead away from the nearer bound.
    middle = np.array([0.5 * (u.low + u.high) if u.kind == "parameter" else 0.0 for u in residuals.unknowns])
    direction *= np.where(p > middle, -1.0, 1.0)
    table = np.array([residuals(p + k * _NARROW * direction) for k in range(_POINTS)])
    return float(np.sqrt(np.mean(np.diff(table, _ORDER, axis=0) ** 2) / 70.0))


def difference_steps(
    residuals: Residuals, p: NDArray[np.float64], noise: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Steps of central differences with about equal errors by noise and by truncation.

    `p`: shape (p,); `noise`: result of `computed_noise`.

    Returns
    -------
    steps : ndarray of shape (k,), k parameters of the FMU
    sensitivities : ndarray of the same shape
        Root mean square change of the residuals for a change over the whole range.

    Notes
    -----
    The error by noise is noise / h, that by truncation h² f''' / 6, where f''' is estimated by the sensitivity over the
    cube of the range: h = range (3 noise / sensitivity)^(1/3), between 1e-5 and 0.02 of the range.
    """
    base = residuals(p)
    steps, sensitivities = [], []
    for k, u in enumerate(residuals.unknowns[: residuals.count]):
        width = u.high - u.low
        q = p.copy()
        q[k] += _PROBE * width if q[k] + _PROBE * width <= u.high else -_PROBE * width
        change = rms(residuals(q) - base) / _PROBE
        sensitivities.append(change)
        steps.append(width * float(np.clip(np.cbrt(3.0 * noise / max(change, 1e-300)), _MIN_STEP, _MAX_STEP)))
    return np.array(steps), np.array(sensitivities)
