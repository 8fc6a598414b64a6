"""A road of waves in a second FMU."""

import math
from typing import Any

from tests.hosts.systems.partner import Partner
from tests.vehicle.test_road_port import FRICTION, WAVES

WHEELS = ("FL", "FR", "RL", "RR")
ANSWER = ("x", "y", "height", "normal_x", "normal_y", "normal_z", "friction")


class SecondRoad(Partner):
    """Computes the tangent plane of the waves at the requested point."""

    inputs = tuple(f"{w}.{c}" for w in WHEELS for c in "xy")
    outputs = tuple(f"{w}.road_{n}" for w in WHEELS for n in ANSWER)

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)

    def find(self, step: float) -> None:
        for w in WHEELS:
            x, y = self.value[f"{w}.x"], self.value[f"{w}.y"]
            size = math.hypot(1.0, WAVES.slope(x))
            answer = (x, y, WAVES.height(x), -WAVES.slope(x) / size, 0.0, 1.0 / size, FRICTION)
            self.value.update({f"{w}.road_{n}": v for n, v in zip(ANSWER, answer, strict=True)})
