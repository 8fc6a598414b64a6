"""The largest value of a sampled signal, between its samples."""

import numpy as np
from numpy.typing import NDArray


def top(x: NDArray[np.float64], y: NDArray[np.float64]) -> tuple[float, float]:
    """Where a signal is largest, and how large, by a parabola through the largest sample and its neighbours."""
    k = int(np.argmax(y))
    if not 0 < k < len(y) - 1:
        return float(x[k]), float(y[k])
    a, b, c = float(y[k - 1]), float(y[k]), float(y[k + 1])
    bend = a - 2.0 * b + c
    shift = 0.5 * (a - c) / bend if bend < 0.0 else 0.0
    return float(x[k] + shift * (x[k + 1] - x[k])), b - 0.25 * (a - c) * shift
