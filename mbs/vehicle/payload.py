"""Payloads of a car: named masses at points of the chassis."""

import numpy as np

from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.fidelity import Fidelity
from mbs.vehicle.quantities import Payload as PayloadMass
from mbs.vehicle.quantities import Point
from mbs.vehicle.section import Section


class Payload(Section):
    """A person or a piece of luggage."""

    mass: PayloadMass
    """Mass of the payload."""
    point: Point
    """Centre of mass as drawn; left and right are as given, nothing is mirrored."""

    def build(self, b: CarBuilder, name: str, fidelity: Fidelity) -> None:
        """Add the payload.

        `fidelity`: fidelity of the chassis: a frame that may bend takes the force of the payload at several joints.
        """
        body, point = b.chassis.frame, None
        if not fidelity.rigid:
            origin, axes, position = b.chassis.contact_frame
            body = b.chassis.body
            point = origin
            for axis, size in zip(axes, np.subtract(self.point, position), strict=True):
                point = point + axis * float(size)
        payload = b.m.payload(name, body, self.point, mass=self.mass, point=point)
        b.tie(self, "mass", payload, "mass")
