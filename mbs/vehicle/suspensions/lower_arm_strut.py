"""Lower arm, strut fixed in the upright and sliding through its top, toe link."""

from collections.abc import Iterator
from typing import ClassVar, Literal

from mbs.vehicle.geometry import arm, farther, steering_rod
from mbs.vehicle.part import Part
from mbs.vehicle.quantities import Point
from mbs.vehicle.section import Section
from mbs.vehicle.suspensions.strut import StrutBodies, StrutSuspension


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
