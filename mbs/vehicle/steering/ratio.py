"""The ratio of a rack that follows the steering wheel, as a parameter."""

from __future__ import annotations

from mbs.model.records import Guide
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.steering.rack_section import RackSection

OVER = ("steering_wheel_angle", "steering_wheel_speed", "steering_demand_excess")
"""Outputs in radians of the steering wheel, by the travel of the rack."""
TORQUE = "steering_wheel_torque"


def tie_ratio(b: CarBuilder, data: RackSection, held: Guide, turn: float) -> None:
    """Let a parameter write the travel of the rack per turn: to its guide and to the outputs of the steering wheel.

    A table is stretched along the angle. Full lock stays where it is for the rack; the range of the demanded angle
    stays that of the file.

    Parameters
    ----------
    b : CarBuilder
        With the outputs of the steering.
    data : RackSection
        Of the file.
    held : Guide
        Of the travel of the rack, or of the angle in the table.
    turn : float
        Travel of the rack per turn over that guide per radian of the steering wheel.
    """
    name = "rack_per_turn"
    if b.ports.steering is None:
        b.tie(data, name, held, "gain_2", 1.0 / turn, late=True)
    for sensor in b.m.sensors:
        if sensor.name in OVER:
            b.tie(data, name, ("sensor", sensor.name), 0, turn, inverse=True, late=True)
        elif sensor.name == TORQUE:
            weights = [t.weight for t in sensor.terms] or sensor.reals
            for k, weight in enumerate(weights):
                b.tie(data, name, ("sensor", TORQUE), k, weight / data.rack_per_turn, late=True)
