"""Twist beam: two trailing arms, joined by a cross-beam that is stiff in bending and soft in torsion.

Each half is a rigid body. They rotate relative to each other about the shear-centre axis of the cross-beam, against its
torsional stiffness (W. Matschinsky, "Road Vehicle Suspensions", Wiley; J. Reimpell, H. Stoll, J. W. Betzler, "The
Automotive Chassis", Butterworth-Heinemann). In bump both arms rotate about the line through their pivots; in roll each
rotates about the line from its pivot through the middle of the shear-centre axis.

The bushes are ball joints. As the twist of the beam would reduce the distance of the pivots by tenths of a millimetre,
both halves can slide relative to each other along the shear-centre axis. Two degrees of freedom remain, bump and roll;
the axle is symmetric, and each bush has the lateral force of its wheel.
"""

import math
from collections.abc import Iterator
from typing import Literal

from mbs.vehicle.axes import LEFT
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.geometry import MIN_LENGTH, apart, farther
from mbs.vehicle.part import Part
from mbs.vehicle.quantities import Point, TorsionalStiffness
from mbs.vehicle.section import Section
from mbs.vehicle.side import Corner, TieRodEnd, sides
from mbs.vehicle.springs import AxleSprings, line_between
from mbs.vehicle.steering import Steering
from mbs.vehicle.suspensions.suspension_section import SuspensionSection


class TwistBeamPoints(Section):
    """Hard points of the left side."""

    pivot: Point
    """Bush of the trailing arm on the chassis."""
    cross_beam: Point
    """End of the cross-beam at the trailing arm, on its shear-centre axis, which is lateral."""
    spring_lower: Point
    """Lower end of the spring on the axle."""
    spring_upper: Point
    """Upper end of the spring on the chassis."""
    damper_lower: Point
    """Lower end of the damper on the axle."""
    damper_upper: Point
    """Upper end of the damper on the chassis."""

    def faults(self) -> Iterator[str]:
        """Yield faults of short arms, springs and dampers, and of springs and dampers that are upside down."""
        yield from apart(self, "pivot", "cross_beam", "the arm to the cross-beam")
        for part in ("spring", "damper"):
            lower, upper = f"{part}_lower", f"{part}_upper"
            yield from apart(self, lower, upper, f"the {part}", 0.05)
            yield from farther(self, "z", upper, lower, "above", f"the {part} stands on the axle")
            arm = math.hypot(*(getattr(self, lower)[k] - self.pivot[k] for k in (0, 2)))
            if arm < MIN_LENGTH:
                yield (
                    f"{self.key(lower)} is {arm:.3g} m from the axis of {self.key('pivot')}; the lever of the {part} "
                    f"is {MIN_LENGTH:g} m long or more."
                )


class TwistBeamBodies(Section):
    """Parts of the left side."""

    half: Part
    """Left half of the axle with half the cross-beam, hub and brake, without wheel."""


class TwistBeam(SuspensionSection):
    """Suspension by a twist beam; it cannot steer."""

    kind: Literal["twist_beam"]
    """Names this template."""
    torsional_stiffness: TorsionalStiffness
    """Torque of the cross-beam per angle between both trailing arms."""
    points: TwistBeamPoints
    """Hard points."""
    bodies: TwistBeamBodies
    """Masses and inertias."""

    def steering_faults(self, steering: Steering | None) -> Iterator[str]:
        """Yield a fault of a steered axle: it cannot steer."""
        if steering is not None:
            yield f"{self.key('kind')} is '{self.kind}'; such an axle cannot steer and may be the rear one only."

    def corners(self, b: CarBuilder, axle: str, springs: AxleSprings, tie_rod: TieRodEnd) -> Iterator[Corner]:
        """Add the left half, then the right one, then the cross-beam.

        `axle`, `springs`: as in `IndependentSuspension.corners`; `tie_rod`: not used.
        """
        m, chassis = b.m, b.chassis.body
        halves = []
        for side in sides(axle):
            w = side.wheel
            p = {name: side.point(point) for name, point in self.points}
            half = side.body(m, "half axle", self.bodies.half)
            m.spherical(f"pivot {w}", half, chassis, point=p["pivot"])
            halves.append(half)
            lines = (
                line_between((half, p[f"{part}_lower"]), (chassis, p[f"{part}_upper"])) for part in ("spring", "damper")
            )
            springs.build(b, w, *lines)
            yield Corner(side, half, {"half": half})
        left, right = halves
        x, _, z = self.points.cross_beam
        m.cylindrical(f"cross-beam {axle}", left, right, point=(x, 0.0, z), axis=LEFT)
        twist = m.relative_angle(f"twist {axle}", left, right, axis=LEFT)
        beam = m.torsional_spring_damper(f"cross-beam {axle}", twist, stiffness=self.torsional_stiffness)
        b.tie(self, "torsional_stiffness", beam, "stiffness")
