"""Cars on a rigid chassis, and with a steering column, which does not stand on a flexible frame."""

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


def rigid_chassis(name: str = "prototype", **steering: object) -> Car:
    """A car of the package without its flexible frame, with other numbers of the steering."""
    car = load(name)
    data = copy.deepcopy(car._data)
    del data["chassis"]["frame"]
    data["steering"] |= steering
    return car_from(data, car.folder, f"car '{name}'")


def column_car(name: str = "prototype", **changes: object) -> Car:
    """One with a steering column."""
    return rigid_chassis(name, **(COLUMN | changes))
