"""Payloads of a car: named masses at points of the chassis."""

from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.quantities import Payload as PayloadMass
from mbs.vehicle.quantities import Point
from mbs.vehicle.section import Section


class Payload(Section):
    """A person or a piece of luggage."""

    mass: PayloadMass
    """Mass of the payload."""
    point: Point
    """Centre of mass as drawn; left and right are as given, nothing is mirrored."""

    def build(self, b: CarBuilder, name: str) -> None:
        """Add the payload, whose force a frame that may bend takes at several joints."""
        point = None if b.chassis.rigid else b.chassis.place(self.point)
        payload = b.m.payload(name, b.chassis.body, self.point, mass=self.mass, point=point)
        b.tie(self, "mass", payload, "mass")
