"""Loads between the instants at which two runs are compared: that one has a load which the other has not."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d, uniform_filter1d

Array = NDArray[np.float64]
WIDTH = 3  # samples: of the means that are compared, and by how many one run may be late


def missed_load(one: Array, other: Array) -> float:
    """Largest load of one run, or lack of it, that the other does not have within `WIDTH` samples.

    Compared are means of `WIDTH` samples: a landing that comes a sample later, or whose peak lies between two samples,
    has the same mean. Shorter runs have none.

    `one`, `other`: the load at the same samples, shape (n,).
    """
    if len(one) < 2 * WIDTH:
        return 0.0
    means = [uniform_filter1d(load, WIDTH, mode="nearest") for load in (one, other)]
    gap = 0.0
    for a, b in (means, means[::-1]):
        most = maximum_filter1d(b, 2 * WIDTH + 1, mode="nearest")
        least = -maximum_filter1d(-b, 2 * WIDTH + 1, mode="nearest")
        gap = max(gap, float(np.max(a - most)), float(np.max(least - a)))
    return gap
