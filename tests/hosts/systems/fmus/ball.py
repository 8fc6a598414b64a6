"""The ball of a hitch in its cup, in a second FMU."""

from typing import Any

from tests.hosts.systems.partner import Partner
from tests.hosts.systems.trailer import DAMPING, STIFFNESS


class Ball(Partner):
    """Spring and damper between a point of the car and one of the trailer; the forces on both."""

    inputs = tuple(f"{end}.{n}{c}" for end in ("car", "trailer") for n in "pv" for c in "xyz")
    outputs = tuple(f"{end}.F{c}" for end in ("car", "trailer") for c in "xyz")

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)

    def find(self, step: float) -> None:
        for c in "xyz":
            gap, rate = (self.value[f"trailer.{n}{c}"] - self.value[f"car.{n}{c}"] for n in "pv")
            force = -STIFFNESS * gap - DAMPING * rate
            self.value[f"trailer.F{c}"], self.value[f"car.F{c}"] = force, -force
