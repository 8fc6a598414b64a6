"""The peak of a sampled signal, interpolated between samples."""

import numpy as np
from numpy.typing import NDArray


def interpolated_peak(x: NDArray[np.float64], y: NDArray[np.float64]) -> tuple[float, float]:
    """Position and height of the peak of a signal, by a parabola through the largest sample and its neighbours.

    `x`, `y`: equally spaced samples, shape (n,).
    """
    k = int(np.argmax(y))
    if not 0 < k < len(y) - 1:
        return float(x[k]), float(y[k])
    a, b, c = float(y[k - 1]), float(y[k]), float(y[k + 1])
    curvature = a - 2.0 * b + c
    shift = 0.5 * (a - c) / curvature if curvature < 0.0 else 0.0
    return float(x[k] + shift * (x[k + 1] - x[k])), b - 0.25 * (a - c) * shift
