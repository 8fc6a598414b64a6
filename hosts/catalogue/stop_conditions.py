"""Conditions that end a run of a test early: the car stands, has spun or has rolled over."""

import math
from collections.abc import Mapping

SPUN = math.radians(90.0)
ROLLED = math.radians(60.0)


class StopConditions:
    """Conditions of the end of a run, as a function of its outputs.

    `stands`: speed below which the car stands, m/s; 0: standing does not end the run. `reason`: ``stands``, ``spun`` or
    ``rolled`` by the last call; empty: the run continues.
    """

    def __init__(self, stands: float) -> None:
        self.stands = stands
        self.reason = ""

    def __call__(self, outputs: Mapping[str, float]) -> bool:
        """Whether the run is over; missing outputs are ignored."""
        self.reason = ""
        if abs(outputs.get("chassis.roll", 0.0)) > ROLLED:
            self.reason = "rolled"
        elif outputs["speed"] > 1.0 and abs(outputs.get("sideslip", 0.0)) > SPUN:
            self.reason = "spun"
        elif outputs["speed"] < self.stands:
            self.reason = "stands"
        return bool(self.reason)
