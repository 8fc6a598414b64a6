"""A measured signal: samples over time with a name and a unit."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Signal:
    """A measured signal with its own times of samples."""

    name: str
    """Our name of the variable."""
    source: str
    """Column of the log."""
    unit: str
    """Of `values`."""
    time: NDArray[np.float64]
    """Shape (n,): s, increasing; at the jump of an input the time occurs twice."""
    values: NDArray[np.float64]
    """Shape (n,): finite."""

    @property
    def interval(self) -> float:
        """Median time between samples, s."""
        steps = np.diff(self.time)
        return float(np.median(steps[steps > 0.0]))

    @property
    def jumps(self) -> NDArray[np.float64]:
        """Times that occur twice, s."""
        return np.asarray(self.time[1:][np.diff(self.time) == 0.0])

    def between(self, begin: float, end: float) -> Signal:
        """The samples between two times, s, both included."""
        inside = (self.time >= begin - 1e-9) & (self.time <= end + 1e-9)
        return replace(self, time=self.time[inside], values=self.values[inside])
