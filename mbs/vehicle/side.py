"""Left and right side of an axle: a file has the left side, y of the right one is mirrored."""

from collections.abc import Sequence
from dataclasses import dataclass

from mbs.model.body import Body
from mbs.model.model import Model
from mbs.vehicle.part import Part

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
        """Point of this side for a point of the left side. `left`: position as drawn, m."""
        return (left[0], self.sign * left[1], left[2])

    def body(self, model: Model, name: str, part: Part) -> Body:
        """Add a part of this side as a body with principal axes along the earth axes.

        `name`: its first part, before the name of the wheel; `part`: mass, centre and inertia of the left part.
        """
        return model.body(f"{name} {self.wheel}", mass=part.mass, com=self.point(part.com), inertia=part.inertia)


def sides(axle: str) -> tuple[Side, Side]:
    """Left and right side of an axle. `axle`: "front" or "rear"."""
    return Side(axle, "left", 1.0), Side(axle, "right", -1.0)
