"""Twist beam: two trailing arms, joined by a cross-beam that is stiff in bending and soft in torsion.

Each half is a rigid body. They turn on each other about the shear-centre axis of the cross-beam, against its torsional
stiffness: so W. Matschinsky ("Road Vehicle Suspensions", Wiley) and J. Reimpell, H. Stoll, J. W. Betzler
("The Automotive Chassis", Butterworth-Heinemann) find the kinematics of such an axle. In bump both arms turn about the
line of their pivots; in roll each turns about the line from its pivot through the middle of the shear-centre axis.

The bushes hold the pivots as ball joints. As the beam is twisted the pivots would come nearer to each other by tenths
of a millimetre: by so much both halves may slide on each other along the shear-centre axis. Two freedoms remain, bump
and roll, and mirrored motions are mirrored; each bush takes the side force of its wheel.
"""

import math
from collections.abc import Iterator
from typing import Literal

from mbs.vehicle.axes import LEFT
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.corner import Corner, TieRodEnd
from mbs.vehicle.geometry import LEAST, apart, farther
from mbs.vehicle.part import Part
from mbs.vehicle.quantities import Point, TorsionalStiffness
from mbs.vehicle.section import Section
from mbs.vehicle.side import sides
from mbs.vehicle.springs import AxleSprings, spring_beside_damper
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
        """Arm, spring and damper must have a length, and stand upright."""
        yield from apart(self, "pivot", "cross_beam", "the arm to the cross-beam")
        for part in ("spring", "damper"):
            lower, upper = f"{part}_lower", f"{part}_upper"
            yield from apart(self, lower, upper, f"the {part}", 0.05)
            yield from farther(self, "z", upper, lower, "above", f"the {part} stands on the axle")
            arm = math.hypot(*(getattr(self, lower)[k] - self.pivot[k] for k in (0, 2)))
            if arm < LEAST:
                yield (
                    f"{self.key(lower)} is {arm:.3g} m from the axis of {self.key('pivot')}; the lever of the {part} "
                    f"is {LEAST:g} m long or more."
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
        """Fault of a steered twist-beam axle: it cannot steer."""
        if steering is not None:
            yield f"{self.key('kind')} is '{self.kind}'; such an axle cannot steer and may be the rear one only."

    def corners(self, b: CarBuilder, axle: str, springs: AxleSprings, tie_rod: TieRodEnd) -> Iterator[Corner]:
        """Add the left half, then the right one, then what joins them.

        `axle`, `springs`: as of `IndependentSuspension.corners`; `tie_rod`: of no use here.
        """
        m, chassis = b.m, b.chassis.body
        halves = []
        for side in sides(axle):
            w = side.wheel
            p = {name: side.point(point) for name, point in self.points}
            half = side.body(m, "half axle", self.bodies.half)
            m.spherical(f"pivot {w}", half, chassis, point=p["pivot"])
            halves.append(half)
            spring_beside_damper(
                b,
                w,
                ((half, p["spring_lower"]), (chassis, p["spring_upper"])),
                ((half, p["damper_lower"]), (chassis, p["damper_upper"])),
                springs,
            )
            yield Corner(side, half, {"half": half})
        left, right = halves
        x, _, z = self.points.cross_beam
        m.cylindrical(f"cross-beam {axle}", left, right, point=(x, 0.0, z), axis=LEFT)
        twist = m.relative_angle(f"twist {axle}", left, right, axis=LEFT)
        beam = m.torsional_spring_damper(f"cross-beam {axle}", twist, stiffness=self.torsional_stiffness)
        b.tie(self, "torsional_stiffness", beam, "stiffness")
