"""Rate-limited inputs: each moves towards its requested value by at most a given rate in simulated time."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray


class Inputs:
    """Values of the inputs and their targets.

    `start`: values at every new start, n; `whole`: whether each is an integer, which changes at once. `values`: values
    of the last or next step, shape (n,).
    """

    def __init__(self, start: Sequence[float], whole: Sequence[bool]) -> None:
        self._start, self._whole = np.array(start, float), list(whole)
        self.values = self._start.copy()
        self._targets: list[float] = list(start)
        self._rates: list[float] = [0.0] * len(start)
        self._oldest_request = 0.0

    def want(self, wants: NDArray[np.float64]) -> None:
        """Set the requested values of inputs.

        `wants`: of each input its value, largest change per second (infinite: at once) and the number of the request,
        shape (3 n,); requests before the last `restart` are ignored.
        """
        for k in range(len(self._rates)):
            value, rate, request = wants[3 * k : 3 * k + 3].tolist()
            if request > self._oldest_request:
                self._targets[k] = float(round(value)) if self._whole[k] else value
                self._rates[k] = float("inf") if self._whole[k] else rate

    def restart(self, request: float) -> None:
        """Return to the start values; requests up to this number are ignored."""
        self.values[:] = self._start
        self._targets, self._rates = self._start.tolist(), [0.0] * len(self._rates)
        self._oldest_request = request

    def set_start(self, start: Sequence[float]) -> None:
        """Replace the start values."""
        self._start[:] = start

    def advance(self, step: float) -> None:
        """Move the values towards their targets by one step, s."""
        values = self.values
        for k, (target, rate) in enumerate(zip(self._targets, self._rates, strict=True)):
            value = float(values[k])
            if value != target:
                limit = rate * step
                values[k] = target if abs(target - value) <= limit else value + (limit if target > value else -limit)
