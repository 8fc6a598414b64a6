"""Noise of measured and of simulated signals."""

import numpy as np
from numpy.typing import NDArray

from hosts.compare.deviations import rms
from hosts.compare.residuals import Residuals

_POINTS = 5
_ORDER = 4
_NARROW = 1e-7  # of a range: the residuals are straight over it but for noise
_PROBE = 0.01
_FINEST = 1e-5
_WIDEST = 0.02


def measured_noise(values: NDArray[np.float64]) -> float:
    """Standard deviation of the white noise of a signal that is slow against its samples.

    `values`: shape (n,).

    Notes
    -----
    From the median of third differences, which leave out what is smooth: their variance is 20 times that of the noise.
    """
    third = np.diff(values, 3)
    return float(np.median(np.abs(third)) / 0.6744897501960817 / np.sqrt(20.0))


def computed_noise(residuals: Residuals, p: NDArray[np.float64]) -> float:
    """Root mean square of the noise of the residuals that comes from the FMU's own iterations and rounding.

    `p`: shape (p,).

    Notes
    -----
    From the table of differences over points that are very near each other (Moré and Wild: Estimating computational
    noise, SIAM J. Sci. Comput. 33, 2011); the variance of fourth differences is 70 times that of the noise.
    """
    direction = np.array([u.high - u.low if u.kind == "parameter" else 0.0 for u in residuals.unknowns])
    # Away from bounds on which the start may lie.
    middle = np.array([0.5 * (u.low + u.high) if u.kind == "parameter" else 0.0 for u in residuals.unknowns])
    direction *= np.where(p > middle, -1.0, 1.0)
    table = np.array([residuals(p + k * _NARROW * direction) for k in range(_POINTS)])
    return float(np.sqrt(np.mean(np.diff(table, _ORDER, axis=0) ** 2) / 70.0))


def difference_steps(
    residuals: Residuals, p: NDArray[np.float64], noise: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Steps of central differences for which the errors by noise and by curvature are about equal.

    `p`: shape (p,); `noise`: of `computed_noise`.

    Returns
    -------
    steps : ndarray of shape (parameters of the FMU,)
    sensitivities : ndarray of the same shape
        Root mean square change of the residuals for a change over the whole range.

    Notes
    -----
    The error by noise is noise / h, that by curvature h² f''' / 6, where f''' is taken as the sensitivity over the
    range: h = range (3 noise / sensitivity)^(1/3), between 1e-5 and 0.02 of the range.
    """
    base = residuals(p)
    steps, sensitivities = [], []
    for k, u in enumerate(residuals.unknowns[: residuals.count]):
        width = u.high - u.low
        q = p.copy()
        q[k] += _PROBE * width if q[k] + _PROBE * width <= u.high else -_PROBE * width
        change = rms(residuals(q) - base) / _PROBE
        sensitivities.append(change)
        steps.append(width * float(np.clip(np.cbrt(3.0 * noise / max(change, 1e-300)), _FINEST, _WIDEST)))
    return np.array(steps), np.array(sensitivities)
