"""Left and right: the data give the left side, the right one mirrors y."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from mbs.model import Model
from mbs.model.body import Body

Point = tuple[float, float, float]


@dataclass(frozen=True)
class Side:
    """One side of an axle: ``sign`` is +1 on the left, -1 on the right."""

    axle: str
    name: str
    sign: float

    @property
    def wheel(self) -> str:
        """FL, FR, RL or RR."""
        return self.axle[0].upper() + self.name[0].upper()

    def point(self, left: Sequence[float]) -> Point:
        """A point of this side from the one of the left side."""
        return (left[0], self.sign * left[1], left[2])

    def body(self, model: Model, part: str, data: Mapping[str, Any]) -> Body:
        """A part of this side; its principal inertias are along the earth axes."""
        return model.body(
            f"{part} {self.wheel}", mass=data["mass"], com=self.point(data["com"]), inertia=data["inertia"]
        )


FRONT_SIDES = (Side("front", "left", 1.0), Side("front", "right", -1.0))
REAR_SIDES = (Side("rear", "left", 1.0), Side("rear", "right", -1.0))
