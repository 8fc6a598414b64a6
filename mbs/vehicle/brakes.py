"""Brakes of the four wheels: pedal with a balance between the axles, hand brake on the rear wheels."""

from __future__ import annotations

import math

from mbs.elements.brake import Brake
from mbs.model.carried import Spin
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.corner import Corner
from mbs.vehicle.quantities import Balance, BrakeTorque, HandBrakeTorque, StickStiffness
from mbs.vehicle.section import Section


class AxleBrakes(Section):
    """Brakes of an axle."""

    stick_stiffness: StickStiffness
    """Stiffness of a standing brake about the wheel's axis; critically damped with the wheel."""


class Brakes(Section):
    """Brakes."""

    torque: BrakeTorque
    """Torque on one front and one rear wheel together at full pedal."""
    balance: Balance
    """Share of the front wheel in it."""
    hand_torque: HandBrakeTorque = 0.0
    """Torque on each rear wheel at full hand brake."""
    front: AxleBrakes
    """Brakes of the front wheels."""
    rear: AxleBrakes
    """Brakes of the rear wheels."""

    def build(self, b: CarBuilder, corner: Corner, spin: Spin, spin_inertia: float) -> None:
        """Add the brake of a wheel.

        Parameters
        ----------
        spin_inertia : float
            Of the wheel, kg.m2.
        """
        behind = corner.side.axle == "rear"
        stiffness = (self.rear if behind else self.front).stick_stiffness
        damping = 2.0 * math.sqrt(stiffness * spin_inertia)
        share = 1.0 - self.balance if behind else self.balance
        brake = Brake(self.torque, stiffness, damping, share, self.hand_torque if behind else 0.0)
        hand = b.inputs["hand_brake"].index if behind else None
        name = f"brake {corner.side.wheel}"
        element = b.m.add(brake.record(name, spin.f, spin.g, spin.coordinate, b.inputs["brake"].index, hand))
        b.tie(self, "torque", element, "max_torque")
        b.tie(self, "balance", element, "share", -1.0 if behind else 1.0, 1.0 if behind else 0.0)
        if behind:
            b.tie(self, "hand_torque", element, "hand_torque")
