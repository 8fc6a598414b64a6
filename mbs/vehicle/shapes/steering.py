"""Shapes of the steering: rack or linkage of a Pitman arm, column and steering wheel."""

import math

from mbs.model.checked_shapes import Owner
from mbs.vehicle.axes import LEFT
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.car_content import CarContent
from mbs.vehicle.shapes.appearance import BARE_STEEL, CAST_STEEL, CHROME, DARK_PLASTIC, Looks
from mbs.vehicle.shapes.occupants import COLUMN_TILT, STEERING_WHEEL_RADIUS, driver_place, steering_wheel_place
from mbs.vehicle.side import Point
from mbs.vehicle.steering.pitman_arm import LINK, PitmanArm


def tie_rod_owner(b: CarBuilder, car: CarContent) -> Owner:
    """Owner of the shapes at the inner ends of the tie rods: the rack, or the centre link of a Pitman arm."""
    inner, frame = car.rack_end, b.chassis.frame
    if isinstance(car.steering, PitmanArm):
        ahead, left = car.steering.plane
        x = b.m.sliding("link ahead", frame, at=inner, direction=ahead, way=LINK[0])
        y = b.m.sliding("link aside", x, at=inner, direction=left, way=LINK[1])
        return b.m.turning("centre link", y, at=inner, axis=car.steering.axis, angle=LINK[2])
    name = "sliding rack" if any(body.name == "rack" for body in b.m.bodies) else "rack"
    return b.m.sliding(name, frame, at=(inner[0], 0.0, inner[2]), direction=LEFT, way="steering_rack")


def steering_shapes(looks: Looks) -> None:
    """Draw the rack or linkage, the column and the steering wheel."""
    steering = looks.car.steering
    foot = _draw_linkage(looks, steering) if isinstance(steering, PitmanArm) else _draw_rack(looks)
    chassis = looks.chassis
    centre = steering_wheel_place(looks.car)
    axis = -math.cos(COLUMN_TILT), 0.0, math.sin(COLUMN_TILT)  # to the driver: positive turns are to the left
    wheel = looks.m.turning("steering wheel", chassis, at=centre, axis=axis, angle="steering_wheel_angle")
    looks.shape(wheel, "steering_wheel", radius=STEERING_WHEEL_RADIUS, **DARK_PLASTIC)
    bearing = centre[0] - 0.30 * axis[0], centre[1], centre[2] - 0.30 * axis[2]
    looks.tube((chassis, centre), (chassis, bearing), (chassis, foot), radius=0.012, **BARE_STEEL)


def _draw_rack(looks: Looks) -> Point:
    """Draw the rack; returns the position of its pinion."""
    x, y, z = looks.car.rack_end
    looks.cylinder(looks.rack, ((x, -y, z), (x, y, z)), 0.010 * looks.scale, **CHROME)
    looks.cylinder(looks.chassis, ((x, -0.55 * y, z), (x, 0.55 * y, z)), 0.022 * looks.scale, **BARE_STEEL)
    return x, 0.5 * y * math.copysign(1.0, driver_place(looks.car)[1] or 1.0), z


def _draw_linkage(looks: Looks, steering: PitmanArm) -> Point:
    """Draw the arms and the link; returns the position of the steering box."""
    arms = (steering.arm_pivot, steering.arm_joint), steering.idler
    for pivot, joint in arms:
        looks.tube((looks.chassis, pivot), (looks.rack, joint), radius=0.014, **CAST_STEEL)
        looks.ball((looks.chassis, pivot), 0.030, **BARE_STEEL)
        looks.ball((looks.rack, joint), 0.018)
    x, y, z = looks.car.rack_end
    ends = sorted([arms[0][1], arms[1][1], (x, y, z), (x, -y, z)], key=lambda point: point[1])
    looks.tube(*((looks.rack, point) for point in ends), radius=0.011, **CAST_STEEL)
    return steering.arm_pivot
