"""A pilot that lets another one steer and then holds the mean of its steering."""

from collections.abc import Mapping

from hosts.driving.ground_marks import Mark, marks_of
from hosts.driving.pilots.pilot import Pilot


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
