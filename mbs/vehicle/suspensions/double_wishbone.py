"""Double wishbones, the spring on the lower one, a tie rod to the rack or the chassis."""

import math
from collections.abc import Iterator
from typing import ClassVar, Literal

from mbs.elements.spring_damper import EndStops
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.geometry import apart, arm, farther, off_line, steering_rod
from mbs.vehicle.part import Part
from mbs.vehicle.quantities import HysteresisLoss, Length, MetalStiffness, Point, SmallLength, StopStiffness
from mbs.vehicle.section import Section
from mbs.vehicle.side import Corner, Side, TieRodEnd
from mbs.vehicle.springs import AxleSprings, line_between
from mbs.vehicle.suspensions.independent import IndependentSuspension


class DoubleWishbonePoints(Section):
    """Hard points of the left side."""

    lower_pivot_front: Point
    """Front pivot of the lower wishbone on the chassis."""
    lower_pivot_rear: Point
    """Rear pivot of the lower wishbone on the chassis."""
    upper_pivot_front: Point
    """Front pivot of the upper wishbone on the chassis."""
    upper_pivot_rear: Point
    """Rear pivot of the upper wishbone on the chassis."""
    lower_ball_joint: Point
    """Ball joint of the lower wishbone and the upright."""
    upper_ball_joint: Point
    """Ball joint of the upper wishbone and the upright."""
    tie_rod_inner: Point
    """Inner end of the tie rod: on the rack if the axle steers, otherwise on the chassis."""
    tie_rod_outer: Point
    """Outer end of the tie rod on the upright."""
    spring_lower: Point
    """Lower end of the spring on the lower wishbone."""
    spring_upper: Point
    """Upper end of the spring on the chassis."""

    def faults(self) -> Iterator[str]:
        """Yield faults of short arms, links and springs, and of points that are not where their names say."""
        for part in ("lower", "upper"):
            yield from arm(self, part, "wishbone")
        axis = ("lower_ball_joint", "upper_ball_joint")
        yield from farther(self, "z", axis[1], axis[0], "above", "the steering axis goes through both", 0.05)
        yield from steering_rod(self, "tie rod", axis, "the steering axis")
        yield from apart(self, "spring_lower", "spring_upper", "the spring", 0.05)
        yield from farther(self, "z", "spring_upper", "spring_lower", "above", "the spring carries the car")
        pivots = ("lower_pivot_front", "lower_pivot_rear")
        yield from off_line(self, "spring_lower", pivots, "the lever of the spring", "the axis of the lower wishbone")


class DoubleWishboneBodies(Section):
    """Parts of the left side."""

    lower_wishbone: Part
    """Lower wishbone."""
    upper_wishbone: Part
    """Upper wishbone."""
    upright: Part
    """Upright without wheel."""


class SteeringStop(Section, of=EndStops):
    """Stop of the knuckle on the lower wishbone, from the outer end of the tie rod to the wishbone's front pivot."""

    length: Length
    """Distance of the two points below which it acts."""
    stiffness: StopStiffness
    """Stiffness at the start of contact."""
    travel: SmallLength
    """Compression at which metal meets metal."""
    metal_stiffness: MetalStiffness
    metal_onset: SmallLength
    loss: HysteresisLoss
    """chi, as of the stops of the springs."""


class DoubleWishbone(IndependentSuspension):
    """Suspension by double wishbones."""

    kind: Literal["double_wishbone"]
    """Names this template."""
    points: DoubleWishbonePoints
    """Hard points."""
    bodies: DoubleWishboneBodies
    """Masses and inertias."""
    steering_stop: SteeringStop | None = None
    """Stop that keeps a knuckle pulled out at full lock from turning over."""

    near_wheel: ClassVar[tuple[str, ...]] = ("lower_ball_joint", "upper_ball_joint", "tie_rod_outer")
    """Names of the points on the wheel carrier."""

    @property
    def stop_left_out(self) -> str:
        """Key path of the steering stop if it is missing, otherwise empty."""
        return self.key("steering_stop") if self.steering_stop is None else ""

    def faults(self) -> Iterator[str]:
        """Yield a fault of a steering stop that acts in the drawing."""
        if self.steering_stop is None:
            return
        drawn = math.dist(self.points.tie_rod_outer, self.points.lower_pivot_front)
        if not 0.3 * drawn <= self.steering_stop.length < drawn:
            yield (
                f"{self.steering_stop.key('length')} is {self.steering_stop.length:g} m; it must be less than the "
                f"{drawn:.4g} m between its points as drawn, and no less than {0.3 * drawn:.2g} m."
            )

    def corner(self, b: CarBuilder, side: Side, springs: AxleSprings, tie_rod: TieRodEnd) -> Corner:
        """Add one side."""
        m, chassis, w = b.m, b.chassis.body, side.wheel
        p = {name: side.point(point) for name, point in self.points}
        lower = side.body(m, "lower wishbone", self.bodies.lower_wishbone)
        upper = side.body(m, "upper wishbone", self.bodies.upper_wishbone)
        upright = side.body(m, "upright", self.bodies.upright)
        for part, wishbone in (("lower", lower), ("upper", upper)):
            for end in ("front", "rear"):
                m.spherical(f"{part} wishbone {w} {end} pivot", chassis, wishbone, point=p[f"{part}_pivot_{end}"])
            m.spherical(f"{part} ball joint {w}", wishbone, upright, point=p[f"{part}_ball_joint"])
        m.distance(f"tie rod {w}", (upright, p["tie_rod_outer"]), tie_rod(side, p["tie_rod_inner"]))
        springs.build(b, w, line_between((lower, p["spring_lower"]), (chassis, p["spring_upper"])))
        if (stop := self.steering_stop) is not None:
            ends = (upright, p["tie_rod_outer"]), (lower, p["lower_pivot_front"])
            bump = {f"bump_{name}": getattr(stop, name) for name in ("length", "stiffness", "travel", "loss")}
            m.spring_damper(f"steering stop {w}", *ends, stiffness=0.0, stops=stop.element(EndStops, **bump))
        return Corner(side, upright, {"lower_wishbone": lower, "upper_wishbone": upper, "upright": upright})
