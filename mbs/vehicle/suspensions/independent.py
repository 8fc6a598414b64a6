"""Base class of independent suspensions: two mirrored sides, each steered or held by a rod."""

import math
from abc import abstractmethod
from collections.abc import Iterator
from typing import ClassVar, Literal

from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.quantities import Point
from mbs.vehicle.section import Section
from mbs.vehicle.side import Corner, Side, TieRodEnd, sides
from mbs.vehicle.springs import AxleSprings
from mbs.vehicle.steering import Steering
from mbs.vehicle.suspensions.suspension_section import SuspensionSection

MAX_RATIO = 1.6
"""Accepted ratio of the declared and the estimated wheel angle: the estimate neglects the angle of the tie rods and the
inclination of the steering axis."""


class IndependentSuspension(SuspensionSection):
    """Base class of the templates of independent suspensions."""

    kind: str
    """Names the template."""
    points: Section
    """Hard points of the left side."""
    bodies: Section
    """Masses and inertias."""

    rod: ClassVar[str] = "tie rod"
    """Name of the rod; its points are the same with underscores, `_inner` and `_outer`."""

    def rod_point(self, end: Literal["inner", "outer"]) -> Point:
        """End of the rod of the left side, m."""
        point: Point = getattr(self.points, f"{self.rod.replace(' ', '_')}_{end}")
        return point

    def steering_oddities(self, steering: Steering, centre: Point) -> Iterator[str]:
        """Yield a sentence if the declared wheel angle at full lock does not fit the steering arm and rack travel."""
        angle, angle_key = steering.front_wheel_angle_max, steering.key("front_wheel_angle_max")
        key, travel = steering.lateral_travel
        length = abs(self.rod_point("outer")[0] - centre[0])
        estimate = math.asin(min(1.0, travel / max(length, 1e-3)))
        if not estimate / MAX_RATIO <= angle <= estimate * MAX_RATIO:
            yield (
                f"{angle_key} is {angle:g} rad, but {key}, {travel:.3g} m to the side, on a steering arm {length:.3g} "
                f"m long gives about {estimate:.2g} rad."
            )

    def corners(self, b: CarBuilder, axle: str, springs: AxleSprings, tie_rod: TieRodEnd) -> Iterator[Corner]:
        """Add the left side, then the right one.

        `axle`: "front" or "rear"; `springs`: springs, dampers and stops of the axle; `tie_rod`: returns the owner of
        the inner end of a rod.
        """
        for side in sides(axle):
            yield self.corner(b, side, springs, tie_rod)

    @abstractmethod
    def corner(self, b: CarBuilder, side: Side, springs: AxleSprings, tie_rod: TieRodEnd) -> Corner:
        """Add one side.

        `springs`, `tie_rod`: as in `corners`.
        """
