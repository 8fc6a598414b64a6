"""Compliance of an axle given by curves: its wheels rotate about two elastic axes, one vertical and one longitudinal.

With the compliances c_x, c_y and c_m per force and moment in the contact, the steer angle is u = c_x F_x + c_y F_y +
c_m M_z. By virtual work this is a rotation u of the wheel against the stiffness 1/c_m with a displacement
(c_x, c_y) u/c_m of the contact, a rotation about the elastic centre.

With the compliances g of the inclination and a of the lateral displacement of the contact per lateral force, the wheel
rotates about an axis at the height a/g above the contact, against a spring of the stiffness 1/a at the contact. Along
that axis it slides against 1/b, with the compliance b of the displacement along x. The body that rotates and slides is
the base of the table.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from mbs.elements.scalar_spring_damper import ScalarSpringDamper
from mbs.model.body import Body
from mbs.model.coordinate import Coordinate
from mbs.vehicle.axes import FORWARD, LEFT
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.part import Part
from mbs.vehicle.quantities import DisplacementPerForce, LossTime, SteerPerForce, SteerPerMoment
from mbs.vehicle.section import Section
from mbs.vehicle.side import Point, Side
from mbs.vehicle.suspensions.curve_poses import WheelCurves
from mbs.vehicle.suspensions.curve_table import OTHER_TRAVEL, RACK

STEER_ANGLES = np.linspace(-0.06, 0.06, 7)  # rad, in the table
MIN_HEIGHT = 0.05  # m, of the longitudinal axis
MAX_HEIGHT = 1.5  # m, of the longitudinal axis
BASE_FRACTION = 1e-3  # mass of the base body, relative to the carrier


class Compliance(Section):
    """Steer angle of the left wheel, positive to the left, per force and moment of the road; the right one mirrors it.

    Camber and ways are modelled as a lean about an axis along the car and a slide along it. That axis is the way per
    camber above the contact, or below it if the camber is positive.

    Of an axle that steers the moment alone is given: it turns the wheel as the rack does, against a spring at the end
    of the rack, so that forces turn it by their levers about the steering axis.
    """

    per_moment: SteerPerMoment
    """Per moment about z, positive to the left."""
    per_lateral_force: SteerPerForce = 0.0
    """Per lateral force, positive to the left."""
    per_longitudinal_force: SteerPerForce = 0.0
    """Per longitudinal force, positive forward."""
    camber_per_lateral_force: SteerPerForce = 0.0
    """Camber angle, positive with the top outwards, per lateral force, positive to the left."""
    lateral_per_lateral_force: DisplacementPerForce = 0.0
    """Displacement of the contact to the left per lateral force, without the turn; with a camber only."""
    longitudinal_per_longitudinal_force: DisplacementPerForce = 0.0
    """Displacement of the wheel forward per longitudinal force, without the turn."""
    loss_time: LossTime = 0.001
    """Damping over stiffness."""

    def table_faults(self, second: str) -> Iterator[str]:
        """Yield a sentence if the table has a second variable with which the compliance cannot be combined."""
        if second == OTHER_TRAVEL:
            yield (
                f"{self.path} is there, but the table has {OTHER_TRAVEL}; an axle whose wheels move each other has "
                "none."
            )
        for name in ("per_lateral_force", "per_longitudinal_force"):
            if second == RACK and getattr(self, name):
                yield (
                    f"{self.key(name)} is {getattr(self, name):g} rad/N; of an axle that steers it follows from "
                    f"{self.key('per_moment')} and the table, so leave it out."
                )

    def faults(self) -> Iterator[str]:
        """Yield a fault of the height of the longitudinal axis."""
        camber, lateral = self.camber_per_lateral_force, self.lateral_per_lateral_force
        if not MIN_HEIGHT * abs(camber) <= lateral <= MAX_HEIGHT * abs(camber):
            yield (
                f"{self.key('lateral_per_lateral_force')} is {lateral:g} m/N and "
                f"{self.key('camber_per_lateral_force')} {camber:g} rad/N; their ratio is the height of "
                f"the axis about which the wheel leans, which must be {MIN_HEIGHT:g} to {MAX_HEIGHT:g} m over "
                f"or under the contact."
            )

    def add_base(self, b: CarBuilder, side: Side, centre: Point, part: Part) -> tuple[Body, float]:
        """Add the base body of the table of a wheel; return it with the fraction of the carrier's mass on the table.

        `centre`: centre of the left wheel, m.
        """
        chassis, slide = b.chassis.frame, self.longitudinal_per_longitudinal_force
        lean, lateral = -self.camber_per_lateral_force, self.lateral_per_lateral_force
        if not (lean or slide):
            return chassis, 1.0
        w = side.wheel
        inertia = [BASE_FRACTION * value for value in part.inertia]
        base = b.m.body(f"compliance {w}", mass=BASE_FRACTION * part.mass, com=side.point(part.com), inertia=inertia)
        point = side.point((centre[0], centre[1], lateral / lean if lean else centre[2]))
        for name, end in (("rear", point), ("front", np.add(point, FORWARD))):  # without redundant equations
            b.m.point_on_line(f"compliance axis {w} {name}", (base, end), (chassis, point), axis=FORWARD)
        # springs of 1 m in the direction of the motion: lateral at the contact, longitudinal on the axis
        contact = (point[0], point[1], 0.0)
        for name, end_point, direction, compliance in (
            ("lean", contact, LEFT, lateral),
            ("slide", point, FORWARD, slide),
        ):
            ends = (chassis, np.subtract(end_point, direction)), (base, end_point)
            if compliance:
                spring, stiffness = f"spring of compliance {name} {w}", 1.0 / compliance
                b.m.spring_damper(spring, *ends, stiffness=stiffness, damping=self.loss_time * stiffness)
            else:
                b.m.distance(f"rod against {name} {w}", *ends)
        return base, 1.0 - BASE_FRACTION

    def add_rack_end(self, b: CarBuilder, side: Side, rack: Coordinate, steer_per_rack: float) -> Coordinate:
        """Add the travel of the end of the rack at a wheel, on a spring.

        `rack`: travel of the rack, m; `steer_per_rack`: rad/m.
        """
        end = b.m.travel(f"rack end {side.wheel}")
        stiffness = steer_per_rack**2 / self.per_moment
        law = ScalarSpringDamper(stiffness, stiffness * self.loss_time, unit="N")
        b.m.add(law.record(f"spring of compliance {side.wheel}", end.affine - rack.affine))
        return end

    def add_turn(self, b: CarBuilder, side: Side) -> Coordinate:
        """Add the rotation of a wheel on its spring, rad."""
        turn = b.m.travel(f"compliance steer {side.wheel}", unit="rad")
        law = ScalarSpringDamper(1.0 / self.per_moment, self.loss_time / self.per_moment)
        b.m.add(law.record(f"spring of compliance {side.wheel}", turn.affine))
        return turn

    def turn_curves(self, curves: WheelCurves, side: Side) -> WheelCurves:
        """Curves against travel and rotation from curves against travel alone, with one point of the second
        variable."""
        c, s = np.cos(STEER_ANGLES), np.sin(STEER_ANGLES)
        steer_rotations = np.zeros((len(STEER_ANGLES), 3, 3))
        steer_rotations[:, 0, 0] = steer_rotations[:, 1, 1] = c
        steer_rotations[:, 0, 1], steer_rotations[:, 1, 0], steer_rotations[:, 2, 2] = -s, s, 1.0
        # the right wheel is mirrored: y of the shift is the same, x has the opposite sign
        mirror = np.array([side.sign, 1.0, 0.0])
        shift = mirror * [self.per_longitudinal_force, self.per_lateral_force, 0.0] / self.per_moment
        centres = curves.centres + STEER_ANGLES[:, None] * shift
        rotations = steer_rotations @ curves.rotations
        lengths = {name: np.repeat(values, len(STEER_ANGLES), axis=1) for name, values in curves.lengths.items()}
        return replace(curves, second=STEER_ANGLES, centres=centres, rotations=rotations, lengths=lengths)
