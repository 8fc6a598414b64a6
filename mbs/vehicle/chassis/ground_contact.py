"""Adds the contact points of the chassis with the ground."""

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from mbs.common.errors import ModelError
from mbs.elements.contact_points import ContactPoints
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.chassis.section import GroundContact
from mbs.vehicle.environment import GRAVITY
from mbs.vehicle.side import Point

NAME = "ground contact"


def ground_contact(
    b: CarBuilder, data: GroundContact, mass: float, joints: Callable[[], Mapping[str, NDArray[np.float64]]]
) -> None:
    """Add the points. `mass`: mass of the car, kg; `joints`: returns the positions of the frame's joints by name, m."""
    contact = ContactPoints.for_mass(
        0.25 * mass,
        data.depth,
        loss=data.loss,
        friction_factor=data.friction_factor,
        radius=data.radius,
        gravity=GRAVITY,
    )
    left_points = [_position(data, point, joints) for point in data.points]
    points = np.array([(x, sign * y, z) for x, y, z in left_points for sign in ((1.0, -1.0) if y else (1.0,))])
    origin, axes, position = b.chassis.contact_frame
    b.m.add(contact.record(NAME, origin, axes, points - position, b.road))


def _position(
    data: GroundContact, point: Point | str, joints: Callable[[], Mapping[str, NDArray[np.float64]]]
) -> Point:
    """Position of a contact point, m. Raises `ModelError` if it names a joint that does not exist."""
    if not isinstance(point, str):
        return point
    positions = joints()
    if point not in positions:
        raise ModelError(f"{data.key('points')} names {point!r}; the frame has no such joint.")
    x, y, z = (float(v) for v in positions[point])
    return x, y, z
