"""Suspensions of a lower arm, a strut fixed in the upright that slides through its top, and a rod that steers it."""

from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.geometry import arm, farther, steering_rod
from mbs.vehicle.part import Part
from mbs.vehicle.quantities import Point
from mbs.vehicle.section import Section
from mbs.vehicle.side import Corner, Side, TieRodEnd
from mbs.vehicle.springs import AxleSprings, line_between
from mbs.vehicle.suspensions.independent import IndependentSuspension


class StrutBodies(Section):
    """Parts of the left side."""

    lower_arm: Part
    """Lower arm."""
    upright: Part
    """Upright with the lower part of the strut, without wheel."""


class StrutSuspension(IndependentSuspension):
    """Base of the templates; among their hard points are the pivots and the ball joint of the lower arm, and the top of
    the strut.
    """

    bodies: StrutBodies
    """Masses and inertias."""

    foot: ClassVar[str]
    """Name of the point of the upright on the strut's axis where the spring ends."""

    def corner(self, b: CarBuilder, side: Side, springs: AxleSprings, tie_rod: TieRodEnd) -> Corner:
        """Add one side."""
        m, chassis, w = b.m, b.chassis.body, side.wheel
        p = {name: side.point(point) for name, point in self.points}
        lower = side.body(m, "lower arm", self.bodies.lower_arm)
        upright = side.body(m, "upright", self.bodies.upright)
        for end in ("front", "rear"):
            m.spherical(f"lower arm {w} {end} pivot", chassis, lower, point=p[f"lower_pivot_{end}"])
        m.spherical(f"lower ball joint {w}", lower, upright, point=p["lower_ball_joint"])
        top, bottom = p["strut_top"], p[self.foot]
        m.point_on_line(f"strut {w}", (chassis, top), (upright, bottom), axis=np.subtract(top, bottom))
        inner, outer = side.point(self.rod_point("inner")), side.point(self.rod_point("outer"))
        m.distance(f"{self.rod} {w}", (upright, outer), tie_rod(side, inner))
        springs.build(b, w, line_between((upright, bottom), (chassis, top)))
        return Corner(side, upright, {"lower_arm": lower, "upright": upright})


class LowerArmStrutPoints(Section):
    """Hard points of the left side."""

    lower_pivot_front: Point
    """Front pivot of the lower arm on the chassis."""
    lower_pivot_rear: Point
    """Rear pivot of the lower arm on the chassis."""
    lower_ball_joint: Point
    """Ball joint of arm and upright, lower end of the spring."""
    toe_link_inner: Point
    """Inner end of the toe link: on the chassis, or on the rack if the axle steers."""
    toe_link_outer: Point
    """Outer end of the toe link on the upright."""
    strut_top: Point
    """Top of the strut on the chassis, upper end of the spring; the strut's axis goes through the ball joint."""

    def faults(self) -> Iterator[str]:
        """Yield faults of short arms, links and struts, and of points that are not where their names say."""
        yield from arm(self, "lower", "arm")
        axis = ("lower_ball_joint", "strut_top")
        yield from farther(self, "z", axis[1], axis[0], "above", "the strut stands between both", 0.05)
        yield from steering_rod(self, "toe link", axis, "the axis of the strut")


class LowerArmStrutBodies(StrutBodies):
    """Parts of the left side."""

    upright: Part
    """Upright with the lower half of the strut, without wheel."""


class LowerArmStrut(StrutSuspension):
    """Suspension by a lower arm, a strut and a toe link."""

    kind: Literal["lower_arm_strut"]
    """Names this template."""
    points: LowerArmStrutPoints
    """Hard points."""
    bodies: LowerArmStrutBodies
    """Masses and inertias."""

    foot: ClassVar[str] = "lower_ball_joint"
    rod: ClassVar[str] = "toe link"
    near_wheel: ClassVar[tuple[str, ...]] = ("lower_ball_joint", "toe_link_outer")
    """Names of the points on the wheel carrier."""


class MacPhersonPoints(Section):
    """Hard points of the left side."""

    lower_pivot_front: Point
    """Front pivot of the lower arm on the chassis."""
    lower_pivot_rear: Point
    """Rear pivot of the lower arm on the chassis."""
    lower_ball_joint: Point
    """Ball joint of arm and upright, through which the steering axis goes."""
    strut_lower: Point
    """Lower end of spring and damper on the strut's axis, which is fixed in the upright."""
    strut_top: Point
    """Top mount on the chassis, through which the strut slides and turns; upper end of spring and steering axis."""
    tie_rod_inner: Point
    """Inner end of the tie rod: on the rack if the axle steers, otherwise on the chassis."""
    tie_rod_outer: Point
    """Outer end of the tie rod on the upright."""

    def faults(self) -> Iterator[str]:
        """Yield faults of short arms, rods and struts, and of points that are not where their names say."""
        yield from arm(self, "lower", "arm")
        yield from farther(self, "z", "strut_top", "strut_lower", "above", "the spring stands between both", 0.05)
        axis = ("lower_ball_joint", "strut_top")
        yield from farther(self, "z", axis[1], axis[0], "above", "the steering axis goes through both", 0.05)
        yield from steering_rod(self, "tie rod", axis, "the steering axis")


class MacPhersonBodies(StrutBodies):
    """Parts of the left side."""

    upright: Part
    """Upright with the tube of the strut, without wheel."""


class MacPherson(StrutSuspension):
    """Suspension by MacPherson struts."""

    kind: Literal["macpherson"]
    """Names this template."""
    points: MacPhersonPoints
    """Hard points."""
    bodies: MacPhersonBodies
    """Masses and inertias."""

    foot: ClassVar[str] = "strut_lower"
    near_wheel: ClassVar[tuple[str, ...]] = ("lower_ball_joint", "tie_rod_outer")
    """Names of the points on the wheel carrier."""
