"""The ratio of a steering that follows the steering wheel, as a parameter."""

from __future__ import annotations

from mbs.model.records import Guide
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.steering.steering_section import SteeringSection

OVER = ("steering_wheel_angle", "steering_wheel_speed", "steering_demand_excess")
"""Outputs in radians of the steering wheel, by the travel of the rack or the angle of the arm."""
TORQUE = "steering_wheel_torque"


def tie_ratio(b: CarBuilder, data: SteeringSection, name: str, held: Guide, turn: float, *, inverse: bool) -> None:
    """Let a parameter write the ratio: to its guide and to the outputs of the steering wheel.

    A table is stretched along the angle. Full lock stays where it is for rack or arm; the range of the demanded angle
    stays that of the file.

    `held`: of the travel of the rack, of the angle in the table, or of the angle of the arm; `turn`: ratio over that
    guide per radian of the steering wheel, or of their reciprocals; `inverse`: whether the steering wheel turns the
    more the larger the ratio is.
    """
    value = getattr(data, name)
    if b.ports.steering is None:
        b.tie(data, name, held, "gain_2", 1.0 / turn, inverse=inverse, late=True)
    for sensor in b.m.sensors:
        if sensor.name in OVER:
            b.tie(data, name, ("sensor", sensor.name), 0, turn, inverse=not inverse, late=True)
        elif sensor.name == TORQUE:
            weights = [t.weight for t in sensor.terms] or sensor.reals
            for k, weight in enumerate(weights):
                scale = weight * value if inverse else weight / value
                b.tie(data, name, ("sensor", TORQUE), k, scale, inverse=inverse, late=True)
