"""The linkage of a lower arm, a strut fixed in the upright and a rod that steers it, which several templates share."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

import numpy as np

from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.corner import Corner, TieRodEnd
from mbs.vehicle.part import Part
from mbs.vehicle.side import Point, Side
from mbs.vehicle.springs import AxleSprings, spring_and_damper


class StrutBodies(Protocol):
    """Parts of the left side."""

    @property
    def lower_arm(self) -> Part:
        """Lower arm."""

    @property
    def upright(self) -> Part:
        """Upright with the lower part of the strut, without wheel."""


def strut_corner(
    b: CarBuilder,
    side: Side,
    points: Mapping[str, Point],
    bodies: StrutBodies,
    springs: AxleSprings,
    tie_rod: TieRodEnd,
    *,
    foot: str,
    rod: str,
) -> Corner:
    """Add one side.

    Parameters
    ----------
    side : Side
        Axle, and left or right.
    points : mapping of str to tuple of float
        Hard points of the left side by name, m; among them the pivots and the ball joint of the lower arm, and the top
        of the strut.
    bodies : StrutBodies
        Masses and inertias.
    springs : AxleSprings
        Springs, dampers and stops of the axle.
    tie_rod : TieRodEnd
        Gives what the inner end of the rod hangs on.
    foot : str
        Name of the point of the upright on the strut's axis where the spring ends.
    rod : str
        Name of the rod; its points are the same with underscores, `_inner` and `_outer`.

    Returns
    -------
    Corner
        Carried by the upright.
    """
    m, chassis, w = b.m, b.chassis.body, side.wheel
    p = {name: side.point(point) for name, point in points.items()}
    arm = side.body(m, "lower arm", bodies.lower_arm)
    upright = side.body(m, "upright", bodies.upright)
    for end in ("front", "rear"):
        m.spherical(f"lower arm {w} {end} pivot", chassis, arm, point=p[f"lower_pivot_{end}"])
    m.spherical(f"lower ball joint {w}", arm, upright, point=p["lower_ball_joint"])
    top, bottom = p["strut_top"], p[foot]
    m.point_on_line(f"strut {w}", (chassis, top), (upright, bottom), axis=np.subtract(top, bottom))
    inner, outer = (p[f"{rod.replace(' ', '_')}_{end}"] for end in ("inner", "outer"))
    m.distance(f"{rod} {w}", (upright, outer), tie_rod(side, inner))
    spring_and_damper(b, f"spring {w}", (upright, bottom), (chassis, top), springs)
    return Corner(side, upright, {"lower_arm": arm, "upright": upright})
