"""Lower arm, strut fixed in the upright and sliding through its top, toe link."""

from __future__ import annotations

from collections.abc import Iterator
from typing import ClassVar, Literal

from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.corner import Corner, TieRodEnd
from mbs.vehicle.geometry import arm, farther, steering_rod
from mbs.vehicle.part import Part
from mbs.vehicle.quantities import Point
from mbs.vehicle.section import Section
from mbs.vehicle.side import sides
from mbs.vehicle.springs import AxleSprings
from mbs.vehicle.suspensions.strut import strut_corner


class LowerArmStrutPoints(Section):
    """Hard points of the left side."""

    lower_pivot_front: Point
    """Front pivot of the lower arm on the chassis."""
    lower_pivot_rear: Point
    """Rear pivot of the lower arm on the chassis."""
    lower_ball_joint: Point
    """Ball joint of arm and upright, lower end of the spring."""
    toe_link_inner: Point
    """Inner end of the toe link: on the chassis, or on the rack where the axle steers."""
    toe_link_outer: Point
    """Outer end of the toe link on the upright."""
    strut_top: Point
    """Top of the strut on the chassis, upper end of the spring; the strut's axis goes through the ball joint."""

    def faults(self) -> Iterator[str]:
        """Arm, link, axes and strut must have a length, and be where their names say."""
        yield from arm(self, "lower", "arm")
        axis = ("lower_ball_joint", "strut_top")
        yield from farther(self, "z", axis[1], axis[0], "above", "the strut stands between both", 0.05)
        yield from steering_rod(self, "toe link", axis, "the axis of the strut")


class LowerArmStrutBodies(Section):
    """Parts of the left side."""

    lower_arm: Part
    """Lower arm."""
    upright: Part
    """Upright with the lower half of the strut, without wheel."""


class LowerArmStrut(Section):
    """Suspension by a lower arm, a strut and a toe link."""

    kind: Literal["lower_arm_strut"]
    """Names this template."""
    points: LowerArmStrutPoints
    """Hard points."""
    bodies: LowerArmStrutBodies
    """Masses and inertias."""

    near_wheel: ClassVar[tuple[str, ...]] = ("lower_ball_joint", "toe_link_outer")
    """Points on what carries the wheel."""

    @property
    def steering_arm(self) -> Point:
        """Outer end of the tie rod of the left side, m."""
        return self.points.toe_link_outer

    @property
    def steering_arm_inner(self) -> Point:
        """Inner end of it, m."""
        return self.points.toe_link_inner

    def corners(self, b: CarBuilder, axle: str, springs: AxleSprings, tie_rod: TieRodEnd) -> Iterator[Corner]:
        """Add the left side, then the right one.

        Parameters
        ----------
        axle : str
            "front" or "rear".
        springs : AxleSprings
            Springs, dampers and stops of the axle.
        tie_rod : TieRodEnd
            Gives what the inner ends of the toe links hang on.
        """
        for side in sides(axle):
            yield strut_corner(
                b, side, dict(self.points), self.bodies, springs, tie_rod, foot="lower_ball_joint", rod="toe link"
            )
