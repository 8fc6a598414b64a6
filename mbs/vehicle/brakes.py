"""Brakes of the four wheels."""

from __future__ import annotations

import math

from mbs.elements.brake import Brake
from mbs.model.spin import Spin
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.corner import Corner
from mbs.vehicle.quantities import StickStiffness, Torque
from mbs.vehicle.section import Section


class AxleBrakes(Section):
    """Brakes of an axle."""

    torque: Torque
    """Torque on each wheel at full pedal."""
    stick_stiffness: StickStiffness
    """Stiffness of a standing brake about the wheel's axis; critically damped with the wheel."""


class Brakes(Section):
    """Brakes."""

    front: AxleBrakes
    """Brakes of the front wheels."""
    rear: AxleBrakes
    """Brakes of the rear wheels."""

    def build(self, b: CarBuilder, corner: Corner, spin: Spin) -> None:
        """Add the brake of a wheel.

        Parameters
        ----------
        b : CarBuilder
            The car so far.
        corner : Corner
            Where it is.
        spin : Spin
            Of the wheel.
        """
        axle = corner.side.axle
        data: AxleBrakes = getattr(self, axle)
        inertia = getattr(b.car, axle).wheel.spin_inertia
        damping = 2.0 * math.sqrt(data.stick_stiffness * inertia)
        brake = Brake(data.torque, data.stick_stiffness, damping)
        name = f"brake {corner.side.wheel}"
        element = b.m.add(brake.record(name, spin.f, spin.g, spin.coordinate, b.inputs["brake"].index))
        b.tie(data, "torque", element, "max_torque")
