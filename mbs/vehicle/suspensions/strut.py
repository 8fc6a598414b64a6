"""A lower arm, a strut fixed in the upright and a rod that steers it: the linkage of several templates."""

from typing import ClassVar

import numpy as np

from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.corner import Corner, TieRodEnd
from mbs.vehicle.part import Part
from mbs.vehicle.section import Section
from mbs.vehicle.side import Side
from mbs.vehicle.springs import AxleSprings, spring_and_damper
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
        arm = side.body(m, "lower arm", self.bodies.lower_arm)
        upright = side.body(m, "upright", self.bodies.upright)
        for end in ("front", "rear"):
            m.spherical(f"lower arm {w} {end} pivot", chassis, arm, point=p[f"lower_pivot_{end}"])
        m.spherical(f"lower ball joint {w}", arm, upright, point=p["lower_ball_joint"])
        top, bottom = p["strut_top"], p[self.foot]
        m.point_on_line(f"strut {w}", (chassis, top), (upright, bottom), axis=np.subtract(top, bottom))
        inner, outer = side.point(self.rod_point("inner")), side.point(self.rod_point("outer"))
        m.distance(f"{self.rod} {w}", (upright, outer), tie_rod(side, inner))
        spring_and_damper(b, f"spring {w}", (upright, bottom), (chassis, top), springs)
        return Corner(side, upright, {"lower_arm": arm, "upright": upright})
