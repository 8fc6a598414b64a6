"""Brakes that are on or off by the slip of their wheels, in a second FMU."""

from typing import Any

from tests.hosts.systems.partner import Partner
from tests.vehicle.cars_with_ports import WHEELS

RADIUS = 0.2848  # m
RELEASE = 0.15  # slip
APPLY = 0.08  # slip
TORQUE = {"F": 600.0, "R": 350.0}  # N.m


class OnOffBrakes(Partner):
    """Releases a brake at one slip and applies it at a smaller one."""

    inputs = ("speed", *(f"omega_{w}" for w in WHEELS))
    outputs = tuple(f"torque_{w}" for w in WHEELS)

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.on = dict.fromkeys(WHEELS, True)

    def find(self, step: float) -> None:
        for w in WHEELS:
            slip = 1.0 - self.value[f"omega_{w}"] * RADIUS / max(self.value["speed"], 0.1)
            self.on[w] = slip < (RELEASE if self.on[w] else APPLY)
            self.value[f"torque_{w}"] = TORQUE[w[0]] * self.on[w]

    def memory(self) -> Any:
        return self.on

    def recall(self, memory: Any) -> None:
        self.on = memory
