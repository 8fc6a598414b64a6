"""MacPherson strut: lower arm, strut fixed in the upright and sliding through its top, tie rod to the rack."""

from collections.abc import Iterator
from typing import ClassVar, Literal

from mbs.vehicle.geometry import arm, farther, steering_rod
from mbs.vehicle.part import Part
from mbs.vehicle.quantities import Point
from mbs.vehicle.section import Section
from mbs.vehicle.suspensions.strut import StrutBodies, StrutSuspension


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
