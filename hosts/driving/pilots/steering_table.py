"""A pilot that steers by a table, whatever the car does."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from hosts.common.errors import HostError


class SteeringTable:
    """Steering over time.

    `time`: s, not decreasing; of two equal times the later value is taken, shape (n,); `values`: in the unit of the
    input, linear in between, constant outside, shape (n,). Raises `HostError` if the lengths differ, there are no
    values, or time goes back.
    """

    def __init__(self, time: ArrayLike, values: ArrayLike, name: str = "steering") -> None:
        self.time, self.values = np.asarray(time, np.float64), np.asarray(values, np.float64)
        self.name = name
        if self.time.ndim != 1 or self.time.shape != self.values.shape or not len(self.time):
            raise HostError(
                f"A table of {name} has {self.time.size} times and {self.values.size} values; it must "
                "have as many times as values."
            )
        if (np.diff(self.time) < 0.0).any():
            k = int(np.argmax(np.diff(self.time) < 0.0))
            raise HostError(
                f"A table of {name} goes back from {self.time[k]:g} s to {self.time[k + 1]:g} s; times "
                "must not decrease."
            )

    def act(self, time: float, observation: Mapping[str, float]) -> dict[str, float]:
        # Times are sums with rounding errors, which must not hide a step.
        return {self.name: float(np.interp(time + 1e-9, self.time, self.values))}
