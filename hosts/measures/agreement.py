"""Agreement of two computations of one quantity: their ratio, correlation and offset, and the delay between them."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[np.float64]
MIN_VALUES = 6
"""Fewest values that are compared."""
DELAY_RESOLUTION = 0.02
"""Interval of the delays in the second search, s."""
_FIRST_INTERVAL = 0.1  # s: interval of the delays in the first search
_MAX_DELAY = 1.0  # s: largest delay
_MIN_INCREASE = 0.03  # least increase of the correlation by a delay


@dataclass(frozen=True)
class Agreement:
    """Agreement of a first and a second computation of a quantity."""

    ratio: float
    """Standard deviation of the first over that of the second."""
    correlation: float
    """Pearson's coefficient."""
    offset: float
    """Mean of the first less mean of the second."""
    delay: float
    """Delay of the second behind the first, s; 0 if it does not raise the correlation clearly."""


def agreement(first: Array, second: Callable[[float], Array], least: float) -> Agreement | None:
    """Compare two computations of a quantity; None if both vary by less than `least`, or one does not vary.

    `first`: values, shape (n,); `second`: values as a function of a delay that is removed, s.
    """
    undelayed = second(0.0)
    spreads = float(np.std(first)), float(np.std(undelayed))
    if max(spreads) < least or min(spreads) <= 0.0 or len(first) < MIN_VALUES:
        return None
    return Agreement(
        spreads[0] / spreads[1],
        correlation(first, undelayed),
        float(np.mean(first) - np.mean(undelayed)),
        _delay(first, second),
    )


def correlation(first: Array, second: Array) -> float:
    """Pearson's coefficient of two series, shape (n,); 0 if the second one is constant."""
    return float(np.corrcoef(first, second)[0, 1]) if np.std(second) > 0.0 else 0.0


def _delay(first: Array, second: Callable[[float], Array]) -> float:
    undelayed, best = abs(correlation(first, second(0.0))), 0.0
    for interval, reach in ((_FIRST_INTERVAL, _MAX_DELAY), (DELAY_RESOLUTION, _FIRST_INTERVAL)):
        delays = best + np.arange(-reach, reach + 1e-9, interval)
        correlations = [abs(correlation(first, second(float(delay)))) for delay in delays]
        best, highest = float(delays[int(np.argmax(correlations))]), max(correlations)
    return best if highest > undelayed + _MIN_INCREASE else 0.0
