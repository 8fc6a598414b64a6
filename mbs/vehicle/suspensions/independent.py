"""What templates of independent suspensions share: both sides are alike, each steered or held by a rod."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator
from typing import ClassVar

from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.corner import Corner, TieRodEnd
from mbs.vehicle.quantities import Point
from mbs.vehicle.section import Section
from mbs.vehicle.side import Side, sides
from mbs.vehicle.springs import AxleSprings


class IndependentSuspension(Section):
    """Base of the templates."""

    kind: str
    """Names the template."""
    points: Section
    """Hard points of the left side."""
    bodies: Section
    """Masses and inertias."""

    rod: ClassVar[str] = "tie rod"
    """Name of the rod; its points are the same with underscores, `_inner` and `_outer`."""

    def rod_point(self, end: str) -> Point:
        """Point of the rod of the left side, m.

        Parameters
        ----------
        end : {"inner", "outer"}
            Which.
        """
        point: Point = getattr(self.points, f"{self.rod.replace(' ', '_')}_{end}")
        return point

    @property
    def steering_arm(self) -> Point:
        """Outer end of the rod of the left side, m."""
        return self.rod_point("outer")

    @property
    def steering_arm_inner(self) -> Point:
        """Inner end of it, m."""
        return self.rod_point("inner")

    def corners(self, b: CarBuilder, axle: str, springs: AxleSprings, tie_rod: TieRodEnd) -> Iterator[Corner]:
        """Add the left side, then the right one.

        `axle`: "front" or "rear"; `springs`: springs, dampers and stops of the axle; `tie_rod`: gives what the inner
        ends of the rods hang on.
        """
        for side in sides(axle):
            yield self.corner(b, side, springs, tie_rod)

    @abstractmethod
    def corner(self, b: CarBuilder, side: Side, springs: AxleSprings, tie_rod: TieRodEnd) -> Corner:
        """Add one side.

        `b`, `springs`, `tie_rod`: as of `corners`; `side`: axle, and left or right.
        """
