"""Left and right side of an axle: a file has the left side, y of the right one is mirrored."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from mbs.model.body import Body
from mbs.model.joint_ends import End
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


TieRodEnd: TypeAlias = Callable[[Side, Point], End]
"""Returns the owner of the inner end of a tie rod from its side and the end as drawn, m."""


@dataclass(frozen=True)
class Corner:
    """The side of a suspension at one wheel."""

    side: Side
    """Axle, and left or right."""
    carrier: Body
    """Body that carries the wheel."""
    parts: Mapping[str, Body]
    """Bodies by their names in the file, to which anti-roll bars can be joined."""
