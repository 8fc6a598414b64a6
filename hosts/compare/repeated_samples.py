"""Detects signals that are logged more often than measured, so that each value is repeated in several rows."""

import numpy as np
from numpy.typing import NDArray

_MIN_CHANGES = 6
_MIN_ROWS = 3
_JITTER = 0.2  # of the rows of a value
_REGULAR_FRACTION = 0.95  # of the changes
_EQUAL = 0.01  # relative difference of changes of equal size


def rows_of_a_value(values: NDArray[np.float64]) -> int:
    """Number of rows in which each value is repeated; 1 where each row is measured.

    `values`: shape (n,).

    Notes
    -----
    Repeated values change in equal steps of rows, or a multiple where two values are equal. So does a ramp of a
    coarsely quantized signal, but at least half of its changes are of equal size.
    """
    changes = np.flatnonzero(np.diff(values)) + 1
    if len(changes) < _MIN_CHANGES:
        return 1
    spacings, sizes = np.diff(changes), np.abs(np.diff(values))[changes - 1]
    rows = int(np.median(spacings))
    off = np.abs(spacings - rows * np.maximum(np.round(spacings / rows), 1.0)) <= _JITTER * rows
    median = float(np.median(sizes))
    equal = np.abs(sizes - median) < _EQUAL * median
    return rows if rows >= _MIN_ROWS and off.mean() >= _REGULAR_FRACTION and equal.mean() < 0.5 else 1
