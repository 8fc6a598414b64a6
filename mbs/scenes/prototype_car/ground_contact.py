"""Where the chassis touches the ground: the outer joints of its frame.

Numbers are assumed. A joint of bare tubes gives a centimetre under a quarter of the car, and most of a hard blow goes
into the frame. Tubes and panels slide at a coefficient of 0.5 where the tyres have 0.9.
"""

from __future__ import annotations

import numpy as np

from mbs.elements.contact_points import ContactPoints
from mbs.model import Model
from mbs.scenes.prototype_car import car_data
from mbs.scenes.prototype_car.chassis import Chassis
from mbs.scenes.prototype_car.frame import joint_places
from mbs.scenes.prototype_car.tyre_data import FRICTION

NAME = "ground contact"
JOINTS = (  # of the left side, each with its image
    *("F1L", "D1L", "S1L", "B1L", "C1L"),  # underbody: front corner, dash, sill, bulkhead, rear corner
    *("F2L", "TFL", "D3L", "S2L", "C2L", "TRL"),  # nose, spring tower, dash hoop, side, tail, strut tower
    *("B4L", "B3L"),  # shoulder and top of the roll hoop
)
TUBE_RADIUS = 0.020  # m
DEPTH = 0.010  # m, under a quarter of the car
LOSS = 0.5  # s/m
SLIDING_FRICTION = 0.5


def ground_contact(m: Model, chassis: Chassis, road: int) -> None:
    """Add the points and what they report."""
    contact = ContactPoints.for_mass(
        0.25 * car_data.TOTAL_MASS,
        DEPTH,
        loss=LOSS,
        friction_factor=SLIDING_FRICTION / FRICTION,
        radius=TUBE_RADIUS,
        gravity=car_data.GRAVITY,
    )
    places = joint_places()
    points = np.array([places[j[:-1] + side] for j in JOINTS for side in "LR"])
    origin, axes, place = chassis.contact_frame
    m.add(contact.record(NAME, origin, axes, points - place, road))
    force = m.sense_element(
        "chassis.ground_force",
        NAME,
        "normal_force",
        description="sum of the normal forces of the ground on the chassis itself; 0 while only tyres touch",
    )
    m.notice(force, "The chassis touches the ground")
    m.sense_element(
        "chassis.ground_points",
        NAME,
        "touching",
        description="number of points of the chassis that touch the ground",
    )
