"""Several pilots as one."""

from collections.abc import Mapping

from hosts.driving.ground_marks import Mark, marks_of
from hosts.driving.pilots.pilot import Pilot


class CombinedPilot:
    """Pilots that share a car, such as one who steers and one who holds the speed.

    `pilots`: of two that act on an input the later one counts.
    """

    def __init__(self, *pilots: Pilot) -> None:
        self.pilots = pilots

    @property
    def marks(self) -> list[Mark]:
        """Marks of all pilots."""
        return [mark for pilot in self.pilots for mark in marks_of(pilot)]

    def act(self, time: float, observation: Mapping[str, float]) -> dict[str, float]:
        acts: dict[str, float] = {}
        for pilot in self.pilots:
            acts |= pilot.act(time, observation)
        return acts
