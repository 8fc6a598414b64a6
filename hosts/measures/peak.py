"""The interpolated peak of a sampled signal, and the direction of its first half wave."""

import math

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


def first_direction(values: NDArray[np.float64]) -> float:
    """Sign of the first half wave of a signal: of its first sample above half of the largest; 1 for a zero signal."""
    indices = np.flatnonzero(np.abs(values) > 0.5 * np.abs(values).max())
    return math.copysign(1.0, float(values[indices[0]])) if len(indices) else 1.0
