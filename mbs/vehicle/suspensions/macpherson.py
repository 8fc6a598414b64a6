"""MacPherson strut: lower arm, strut fixed in the upright and sliding through its top, tie rod to the rack."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

import numpy as np

from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.corner import Corner, TieRodEnd
from mbs.vehicle.part import Part
from mbs.vehicle.quantities import Point
from mbs.vehicle.section import Section
from mbs.vehicle.side import sides
from mbs.vehicle.springs import AxleSprings, spring_and_damper


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
    """Inner end of the tie rod: on the rack where the axle steers, else on the chassis."""
    tie_rod_outer: Point
    """Outer end of the tie rod on the upright."""


class MacPhersonBodies(Section):
    """Parts of the left side."""

    lower_arm: Part
    """Lower arm."""
    upright: Part
    """Upright with the tube of the strut, without wheel."""


class MacPherson(Section):
    """Suspension by MacPherson struts."""

    kind: Literal["macpherson"]
    """Names this template."""
    points: MacPhersonPoints
    """Hard points."""
    bodies: MacPhersonBodies
    """Masses and inertias."""

    @property
    def steering_arm(self) -> Point:
        """Outer end of the tie rod of the left side, m."""
        return self.points.tie_rod_outer

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
            Gives what the inner ends of the tie rods hang on.
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
            strut = np.subtract(p["strut_top"], p["strut_lower"])
            m.point_on_line(f"strut {w}", (chassis, p["strut_top"]), (upright, p["strut_lower"]), axis=strut)
            m.distance(f"tie rod {w}", (upright, p["tie_rod_outer"]), tie_rod(side, p["tie_rod_inner"]))
            spring_and_damper(b, f"spring {w}", (upright, p["strut_lower"]), (chassis, p["strut_top"]), springs)
            yield Corner(side, upright, {"lower_arm": arm, "upright": upright})
