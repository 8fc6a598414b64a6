"""Variances of least-squares parameters when the residuals are correlated in time.

White noise would give s² (J'J)⁻¹, which is too small if neighbouring residuals correlate. Here (J'J)⁻¹ (J'ΩJ) (J'J)⁻¹
is used, where Ω is the covariance of an autoregressive process fitted to the residuals of each signal (Yule and Walker;
order by Akaike's criterion); see Ljung, System Identification, 2nd ed., 9.
"""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import matmul_toeplitz, solve_toeplitz

_MAX_LAGS = 4000


def autocovariance(residual: NDArray[np.float64]) -> NDArray[np.float64]:
    """Autocovariances of an autoregressive process fitted to a signal. `residual`: equally spaced, shape (n,).

    Returns an array of shape (n,): at lags 0 to n - 1; those beyond 4000 are 0.
    """
    n = len(residual)
    size = 1 << (2 * n - 1).bit_length()
    spectrum = np.fft.rfft(residual, size)
    sample = np.fft.irfft(spectrum * spectrum.conj(), size)[:n] / n
    covariances = np.zeros(n)
    if sample[0] <= 0.0:
        return covariances
    highest_order = max(1, min(n // 10, int(10.0 * math.log10(n))))
    best, a = math.inf, np.zeros(0)
    for order in range(highest_order + 1):
        trial = solve_toeplitz(sample[:order], sample[1 : order + 1]) if order else np.zeros(0)
        innovation = sample[0] - float(trial @ sample[1 : order + 1])
        # Of a smooth residual rounding errors may leave a variance of zero or less.
        criterion = n * math.log(max(innovation, 1e-14 * sample[0])) + 2.0 * order
        if criterion < best:
            best, a = criterion, trial
    order = len(a)
    covariances[: order + 1] = sample[: order + 1]
    for k in range(order + 1, min(n, _MAX_LAGS) if order else 0):
        covariances[k] = a @ covariances[k - order : k][::-1]
    return covariances


def effective_samples(residual: NDArray[np.float64]) -> float:
    """Number of uncorrelated samples that determine a mean as well as `residual`, between 1 and n."""
    n = len(residual)
    c = autocovariance(residual - residual.mean())
    if c[0] <= 0.0:
        return float(n)
    inflation = 1.0 + 2.0 * float(np.sum((1.0 - np.arange(1, n) / n) * c[1:])) / c[0]
    return float(np.clip(n / max(inflation, 1e-12), 1.0, n))


def variance_inflation(times: Sequence[NDArray[np.float64]], influences: Sequence[NDArray[np.float64]]) -> float:
    """Factor by which residuals that correlate between signals raise the variance of a parameter; 1 if independent.

    `times`: equally spaced times of each signal, s, shape (n,); `influences`: change of the parameter by each residual
    of the signal, shape (n,).

    Notes ----- Square of the sum of all signals divided by the sum of their squares, each summed over time: 1 on
    average for independent signals, the number of signals for equal ones.
    """
    interval = max(float(np.median(np.diff(t))) for t in times)
    begin = min(t[0] for t in times) - 0.5 * interval
    count = 1 + max(int((t[-1] - begin) / interval) for t in times)
    sums = [
        np.bincount(((t - begin) / interval).astype(int), influence, count)
        for t, influence in zip(times, influences, strict=True)
    ]
    separate = float(np.sum(np.square(sums)))
    return max(1.0, float(np.sum(np.sum(sums, axis=0) ** 2)) / separate) if separate > 0.0 else 1.0


def covariance(
    jacobian: NDArray[np.float64],
    residual: NDArray[np.float64],
    blocks: Sequence[slice],
    times: Sequence[NDArray[np.float64]],
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Covariance of parameters: covariance for independent signals, times the `variance_inflation` of each parameter.

    Parameters
    ----------
    jacobian : ndarray of shape (n, p)
        Derivatives of the residuals at the solution.
    residual : ndarray of shape (n,)
    blocks : sequence of slice
        The rows of each signal, equally spaced in time.
    times : sequence of ndarray of shape (n,)
        Of the rows of each signal, s.

    Returns
    -------
    covariance : ndarray of shape (p, p)
        Infinite on the diagonal of parameters that are not determined.
    lost : ndarray of bool, shape (p,)
        Parameters that are not determined.
    """
    n, p = jacobian.shape
    size = np.linalg.norm(jacobian, axis=0)
    scale = np.where(size > 0.0, size, 1.0)
    u, s, vt = np.linalg.svd(jacobian / scale, full_matrices=False)
    determined = s > max(s[0], 1e-300) * 1e-7
    undetermined = (np.abs(vt[~determined]) > 0.1).any(axis=0) | (size == 0.0)
    inverse = vt[determined].T / s[determined]  # of shape (p, determined)
    meat = np.zeros((determined.sum(), determined.sum()))
    for rows in blocks:
        block_residual, vectors = residual[rows], u[rows][:, determined]
        c = autocovariance(block_residual) * (n / max(n - p, 1))
        meat += vectors.T @ matmul_toeplitz(c, vectors)
    result = inverse @ meat @ inverse.T / np.outer(scale, scale)
    influences = inverse @ u[:, determined].T * residual
    inflations = np.sqrt([variance_inflation(times, [vectors[rows] for rows in blocks]) for vectors in influences])
    result *= np.outer(inflations, inflations)
    result[undetermined, :], result[:, undetermined] = 0.0, 0.0
    result[undetermined, undetermined] = math.inf
    return result, undetermined
