"""Detects signals that are logged more often than measured, so that each value is repeated in several rows."""

import numpy as np
from numpy.typing import NDArray

_FEWEST = 6  # changes, of which something can be said
_LEAST = 3  # rows of a value
_OFF = 0.2  # of these, by which a logger writes a value sooner or later
_MOST = 0.95  # of the changes
_EQUAL = 0.01  # of the size of a change


def rows_of_a_value(values: NDArray[np.float64]) -> int:
    """In how many rows each value stands; 1 where they are measured row by row.

    `values`: of a signal that moves at will, shape (n,).

    Notes
    -----
    Changes come in equal steps of rows, a few of them left out where two values are equal. A ramp of a coarse signal
    does so too, but by equal amounts: half of the changes and more have then one size.
    """
    changes = np.flatnonzero(np.diff(values)) + 1
    if len(changes) < _FEWEST:
        return 1
    spacings, sizes = np.diff(changes), np.abs(np.diff(values))[changes - 1]
    rows = int(np.median(spacings))
    off = np.abs(spacings - rows * np.maximum(np.round(spacings / rows), 1.0)) <= _OFF * rows
    usual = float(np.median(sizes))
    equal = np.abs(sizes - usual) < _EQUAL * usual
    return rows if rows >= _LEAST and off.mean() >= _MOST and equal.mean() < 0.5 else 1
