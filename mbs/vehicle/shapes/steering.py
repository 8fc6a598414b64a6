"""Looks of the steering: rack that slides, column, steering wheel that turns."""

from __future__ import annotations

import math

from mbs.model.shapes import Owner
from mbs.vehicle.axes import LEFT
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.car_content import CarContent
from mbs.vehicle.shapes.looks import BARE, DARK, POLISHED, Looks
from mbs.vehicle.shapes.occupants import driver_place

TILT = math.radians(24.0)  # of the column from the level
HANDS = 0.42, 0.26  # m: steering wheel before and above the driver's centre of mass
RADIUS = 0.185  # m, of the steering wheel


def rack_of(b: CarBuilder, car: CarContent) -> Owner:
    """What the inner ends of the tie rods move with: a slide by the travel of the rack, which is always an output."""
    inner = car.rack_ends
    name = "sliding rack" if any(body.name == "rack" for body in b.m.bodies) else "rack"
    return b.m.sliding(name, b.chassis.frame, at=(inner[0], 0.0, inner[2]), direction=LEFT, way="steering_rack")


def steering_shapes(looks: Looks) -> None:
    """Draw rack, column and steering wheel."""
    car, chassis = looks.car, looks.chassis
    x, y, z = car.rack_ends
    looks.cylinder(looks.rack, ((x, -y, z), (x, y, z)), 0.010 * looks.scale, **POLISHED)
    looks.cylinder(chassis, ((x, -0.55 * y, z), (x, 0.55 * y, z)), 0.022 * looks.scale, **BARE)
    seat = driver_place(car)
    centre = seat[0] + HANDS[0], seat[1], seat[2] + HANDS[1]
    axis = -math.cos(TILT), 0.0, math.sin(TILT)  # to the driver: positive turns are to the left
    wheel = looks.m.turning("steering wheel", chassis, at=centre, axis=axis, angle="steering_wheel_angle")
    looks.m.shape(wheel, "steering_wheel", radius=RADIUS, **DARK)
    bearing = centre[0] - 0.30 * axis[0], centre[1], centre[2] - 0.30 * axis[2]
    pinion = x, 0.5 * y * math.copysign(1.0, seat[1] or 1.0), z
    looks.tube((chassis, centre), (chassis, bearing), (chassis, pinion), radius=0.012, **BARE)
