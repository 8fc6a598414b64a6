"""The interface of a pilot: outputs of a car in, inputs of the car out."""

from collections.abc import Mapping, Sequence
from typing import Protocol

from hosts.common.errors import HostError

OBSERVED = ("chassis.x", "chassis.y", "chassis.yaw", "speed")
"""Outputs that a driver of a course needs."""
ACTS = ("steering", "throttle", "brake")
"""Inputs that a driver of a course needs."""


def refuse_missing(names: Sequence[str], owner: str) -> None:
    """Raise `HostError` if `names`, of missing variables, has any. `owner`: the FMU, for messages."""
    if names:
        raise HostError(
            f"The driver needs variables that {owner} does not have: {', '.join(names)}. Where they have other names, "
            "an alias file says which (--aliases)."
        )


class Pilot(Protocol):
    """A driver: from the outputs of the car to its inputs."""

    def act(self, time: float, observation: Mapping[str, float]) -> dict[str, float]:
        """Inputs for the next communication step. `time`: s; `observation`: outputs before it, by our names."""
        ...
