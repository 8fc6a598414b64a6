"""Pilots that steer by a table or hold an angle, whatever the car does."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from hosts.common.errors import HostError
from hosts.driving.ground_marks import Mark, marks_of
from hosts.driving.pilots.pilot import Pilot


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


class FixedSteering:
    """Drives as another pilot, but with a fixed steering from a time on.

    `fixed_at`: s; `mean_over`: duration before it, s, over which the fixed steering is the mean; `value`: the fixed
    steering; None before.
    """

    def __init__(self, pilot: Pilot, fixed_at: float, mean_over: float) -> None:
        self.pilot = pilot
        self.fixed_at = fixed_at
        self.mean_over = mean_over
        self.value: float | None = None
        self._sum = 0.0
        self._count = 0

    @property
    def marks(self) -> list[Mark]:
        """Marks of the other pilot."""
        return marks_of(self.pilot)

    def act(self, time: float, observation: Mapping[str, float]) -> dict[str, float]:
        acts = dict(self.pilot.act(time, observation))
        if self.value is None and time >= self.fixed_at - 1e-9 and self._count:
            self.value = self._sum / self._count
        if self.value is not None:
            return {**acts, "steering": self.value}
        if time >= self.fixed_at - self.mean_over - 1e-9:
            self._sum += acts["steering"]
            self._count += 1
        return acts
