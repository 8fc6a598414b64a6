"""Brakes of the four wheels: pedal with a balance between the axles, hand brake on the rear wheels."""

import math

from mbs.elements.brake import Brake
from mbs.model.carried_parts import Spin
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.inputs import brake_port
from mbs.vehicle.quantities import Balance, BrakeSide, BrakeTorque, HandBrakeTorque, StickStiffness
from mbs.vehicle.section import Section
from mbs.vehicle.side import Corner


class AxleBrakes(Section, of=Brake):
    """Brakes of an axle; standing, they are critically damped with the wheel."""

    stick_stiffness: StickStiffness


class Brakes(Section):
    """Brakes."""

    torque: BrakeTorque
    """Torque on one front and one rear wheel together at full pedal."""
    balance: Balance
    """Share of the front wheel in it."""
    hand_torque: HandBrakeTorque = 0.0
    """Torque on each rear wheel at full hand brake."""
    side: BrakeSide = 0.0
    """Half of the difference of the pedal's torques left and right, relative to their mean; above 0 braking turns
    left."""
    front: AxleBrakes
    """Brakes of the front wheels."""
    rear: AxleBrakes
    """Brakes of the rear wheels."""

    def shares(self, wheel: str) -> tuple[float, float]:
        """Share of a wheel, such as "FL", in `torque`, and the factor of its side of the car."""
        share = 1.0 - self.balance if wheel.startswith("R") else self.balance
        return share, 1.0 + (self.side if wheel.endswith("L") else -self.side)

    def build(self, b: CarBuilder, corner: Corner, spin: Spin, spin_inertia: float) -> None:
        """Add the brake of a wheel. `spin_inertia`: moment of inertia of the wheel, kg m2."""
        is_rear = corner.side.axle == "rear"
        stiffness = (self.rear if is_rear else self.front).stick_stiffness
        damping = 2.0 * math.sqrt(stiffness * spin_inertia)
        share, side = self.shares(corner.side.wheel)
        sign = 1.0 if corner.side.wheel.endswith("L") else -1.0
        by_size = b.ports.brakes is not None
        per_unit = 1.0 / b.ports.full_pressure if b.ports.brakes == "pressure" else 1.0
        torque = self.torque * per_unit
        if b.ports.brakes == "torque":
            torque = share = side = 1.0
        channel = brake_port(b, corner.side.wheel) if by_size else b.inputs["brake"]
        brake = Brake(torque, stiffness, damping, share, self.hand_torque if is_rear else 0.0, side)
        hand = b.inputs["hand_brake"].index if is_rear else None
        name = f"brake {corner.side.wheel}"
        element = b.m.add(brake.record(name, spin.f, spin.g, spin.coordinate, channel.index, hand, by_size=by_size))
        if b.ports.brakes != "torque":
            b.tie(self, "torque", element, "max_torque", per_unit)
            b.tie(self, "balance", element, "share", -1.0 if is_rear else 1.0, 1.0 if is_rear else 0.0)
            b.tie(self, "side", element, "side", sign, 1.0)
        if is_rear:
            b.tie(self, "hand_torque", element, "hand_torque")
