"""Lower arm, strut fixed in the upright and sliding through its top, toe link."""

from __future__ import annotations

from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.corner import Corner, TieRodEnd
from mbs.vehicle.geometry import apart, farther, off_line, steering_axis
from mbs.vehicle.part import Part
from mbs.vehicle.quantities import Point
from mbs.vehicle.section import Section
from mbs.vehicle.side import sides
from mbs.vehicle.springs import AxleSprings, spring_and_damper


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
        pivots = ("lower_pivot_front", "lower_pivot_rear")
        yield from apart(self, *pivots, "the axis of the lower arm")
        yield from farther(self, "x", pivots[0], pivots[1], "ahead of", "so they are called")
        yield from off_line(self, "lower_ball_joint", pivots, "the lower arm", "the axis of its pivots", 0.05)
        for pivot in pivots:
            yield from farther(self, "y", "lower_ball_joint", pivot, "outside of", "the arm carries the wheel")
        axis = ("lower_ball_joint", "strut_top")
        yield from farther(self, "z", axis[1], axis[0], "above", "the strut stands between both", 0.05)
        yield from steering_axis(self, *axis)
        yield from off_line(self, "toe_link_outer", axis, "the steering arm", "the axis of the strut")
        yield from apart(self, "toe_link_inner", "toe_link_outer", "the toe link", 0.05)
        yield from farther(self, "y", "toe_link_outer", "toe_link_inner", "outside of", "so they are called")


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

    def corners(self, b: CarBuilder, axle: str, springs: AxleSprings, tie_rod: TieRodEnd) -> Iterator[Corner]:
        """Add the left side, then the right one.

        Parameters
        ----------
        b : CarBuilder
            The car so far.
        axle : str
            "front" or "rear".
        springs : AxleSprings
            Springs, dampers and stops of the axle.
        tie_rod : TieRodEnd
            Gives what the inner ends of the toe links hang on.
        """
        m, chassis = b.m, b.chassis.body
        for side in sides(axle):
            w = side.wheel
            p = {name: side.point(point) for name, point in self.points}
            arm = side.body(m, "lower arm", self.bodies.lower_arm)
            upright = side.body(m, "upright", self.bodies.upright)
            for end in ("front", "rear"):
                m.spherical(f"lower arm {w} {end} pivot", chassis, arm, point=p[f"lower_pivot_{end}"])
            m.spherical(f"lower ball joint {w}", arm, upright, point=p["lower_ball_joint"])
            strut = np.subtract(p["strut_top"], p["lower_ball_joint"])
            m.point_on_line(f"strut {w}", (chassis, p["strut_top"]), (upright, p["lower_ball_joint"]), axis=strut)
            m.distance(f"toe link {w}", (upright, p["toe_link_outer"]), tie_rod(side, p["toe_link_inner"]))
            spring_and_damper(b, f"spring {w}", (upright, p["lower_ball_joint"]), (chassis, p["strut_top"]), springs)
            yield Corner(side, upright, {"lower_arm": arm, "upright": upright})
