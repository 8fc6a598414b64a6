"""Conditions that end a run of a test early: the car stands, has spun or has rolled over."""

import math
from collections.abc import Mapping

SPUN = math.radians(90.0)
ROLLED = math.radians(60.0)


class StopConditions:
    """Ends a run, and says why.

    `stands`: a car slower than this stands, m/s; 0: it does not end the run. `reason`: ``stands``, ``spun`` or
    ``rolled``; empty while the run goes on; that of the last call.
    """

    def __init__(self, stands: float) -> None:
        self.stands = stands
        self.reason = ""

    def __call__(self, outputs: Mapping[str, float]) -> bool:
        """Whether the run is over; outputs that the car does not have are not looked at."""
        self.reason = ""
        if abs(outputs.get("chassis.roll", 0.0)) > ROLLED:
            self.reason = "rolled"
        elif outputs["speed"] > 1.0 and abs(outputs.get("sideslip", 0.0)) > SPUN:
            self.reason = "spun"
        elif outputs["speed"] < self.stands:
            self.reason = "stands"
        return bool(self.reason)
