"""The interface of a pilot: outputs of a car in, inputs of the car out."""

from collections.abc import Mapping, Sequence
from typing import Protocol

from hosts.common.errors import HostError

OBSERVED = ("chassis.x", "chassis.y", "chassis.yaw", "speed")
"""Outputs without which a course cannot be followed."""
ACTS = ("steering", "throttle", "brake")
"""Inputs without which it cannot."""


def refuse_missing(names: Sequence[str], whose: str) -> None:
    """Raises `HostError` where a driver needs variables that are not there. `whose`: how messages call the FMU."""
    if names:
        raise HostError(
            f"The driver needs variables that {whose} does not have: {', '.join(names)}. Where they have other names, "
            "an alias file says which (--aliases)."
        )


class Pilot(Protocol):
    """A driver: from the outputs of the car to its inputs."""

    def act(self, time: float, observation: Mapping[str, float]) -> dict[str, float]:
        """Inputs for the coming communication step; `observation`: all outputs by our names, until that step."""
        ...
