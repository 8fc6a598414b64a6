"""Compliance of an axle by its curves: its wheels turn about an elastic axis that stands upright.

With the compliances c_x, c_y and c_m of the steer angle u per force and moment in the contact, u = c_x F_x + c_y F_y +
c_m M_z. A turn u of the wheel against the stiffness 1/c_m, with which the contact goes by (c_x, c_y) u/c_m, is just
that by virtual work: it is a turn about the elastic centre.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from mbs.elements.scalar_spring_damper import ScalarSpringDamper
from mbs.model.coordinate import Coordinate
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.quantities import LossTime, SteerPerForce, SteerPerMoment
from mbs.vehicle.section import Section
from mbs.vehicle.side import Side
from mbs.vehicle.suspensions.curve_poses import WheelCurves
from mbs.vehicle.suspensions.curve_table import OTHER, RACK

TURNS = np.linspace(-0.06, 0.06, 7)  # rad: points of the table


class Compliance(Section):
    """Steer angle of the left wheel, positive to the left, per force and moment of the road; the right one mirrors it.

    Of an axle that steers the moment alone is given: it turns the wheel as the rack does, against a spring at the end
    of the rack, so that forces turn it by their levers about the steering axis.
    """

    per_moment: SteerPerMoment
    """Per moment about z, positive to the left."""
    per_lateral_force: SteerPerForce = 0.0
    """Per lateral force, positive to the left."""
    per_longitudinal_force: SteerPerForce = 0.0
    """Per longitudinal force, positive forward."""
    loss_time: LossTime = 0.001
    """Damping over stiffness."""

    def fits(self, second: str) -> Iterator[str]:
        """A sentence where the table of the axle leaves no place for it.

        Parameters
        ----------
        second : str
            Second variable of the table.
        """
        if second == OTHER:
            yield f"{self.path} is there, but the table has {OTHER}; an axle whose wheels move each other has none."
        for name in ("per_lateral_force", "per_longitudinal_force"):
            if second == RACK and getattr(self, name):
                yield (
                    f"{self.key(name)} is {getattr(self, name):g} rad/N; of an axle that steers it follows from "
                    f"{self.key('per_moment')} and the table, so leave it out."
                )

    def rack_end(self, b: CarBuilder, side: Side, rack: Coordinate, steer_per_rack: float) -> Coordinate:
        """Travel of the end of the rack at a wheel, on a spring.

        Parameters
        ----------
        rack : Coordinate
            Travel of the rack, m.
        steer_per_rack : float
            rad/m
        """
        end = b.m.travel(f"rack end {side.wheel}")
        stiffness = steer_per_rack**2 / self.per_moment
        law = ScalarSpringDamper(stiffness, stiffness * self.loss_time, unit="N")
        b.m.add(law.record(f"spring of compliance {side.wheel}", end.affine - rack.affine))
        return end

    def turn(self, b: CarBuilder, side: Side) -> Coordinate:
        """The turn of a wheel on its spring, rad."""
        turn = b.m.travel(f"compliance steer {side.wheel}", unit="rad")
        law = ScalarSpringDamper(1.0 / self.per_moment, self.loss_time / self.per_moment)
        b.m.add(law.record(f"spring of compliance {side.wheel}", turn.affine))
        return turn

    def turned(self, curves: WheelCurves, side: Side) -> WheelCurves:
        """Curves over travel alone as curves over travel and turn.

        Parameters
        ----------
        curves : WheelCurves
            With one point of the second variable.
        """
        c, s = np.cos(TURNS), np.sin(TURNS)
        about = np.zeros((len(TURNS), 3, 3))
        about[:, 0, 0] = about[:, 1, 1] = c
        about[:, 0, 1], about[:, 1, 0], about[:, 2, 2] = -s, s, 1.0
        # the mirrored wheel turns the other way under the mirrored lateral force, and under the same one along x
        mirror = np.array([side.sign, 1.0, 0.0])
        way = mirror * [self.per_longitudinal_force, self.per_lateral_force, 0.0] / self.per_moment
        centres = curves.centres + TURNS[:, None] * way
        rotations = about @ curves.rotations
        lengths = {name: np.repeat(values, len(TURNS), axis=1) for name, values in curves.lengths.items()}
        return replace(curves, second=TURNS, centres=centres, rotations=rotations, lengths=lengths)
