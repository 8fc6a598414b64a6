"""The prototype on a rigid chassis with a steering column."""

from __future__ import annotations

import copy

from mbs.vehicle import Car, load
from mbs.vehicle.car import car_from

COLUMN = {
    "kind": "column",
    "rack_mass": 2.5,
    "wheel_inertia": 0.035,
    "stiffness": 115.0,
    "damping": 0.4,
    "friction": 0.2,
    "rack_friction": 120.0,
}


def column_car(**changes: object) -> Car:
    """Without the flexible frame, on which no column stands."""
    prototype = load("prototype")
    data = copy.deepcopy(prototype._data)
    del data["chassis"]["frame"]
    data["steering"] |= COLUMN | changes
    return car_from(data, prototype.folder, "car 'prototype'")
