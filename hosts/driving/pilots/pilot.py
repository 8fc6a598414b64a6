"""What a pilot is."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

SENSES = ("chassis.x", "chassis.y", "chassis.yaw", "speed")
"""Outputs without which a course cannot be followed."""
ACTS = ("steering", "throttle", "brake")
"""Inputs without which it cannot."""


class Pilot(Protocol):
    """A driver: from the outputs of the car to its inputs."""

    def act(self, time: float, senses: Mapping[str, float]) -> dict[str, float]:
        """Inputs for the coming communication step; `senses` are all outputs by our names, until that step is made."""
        ...
