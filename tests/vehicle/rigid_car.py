"""Cars of the package without their flexible frame, also with a steering column, which such a frame cannot carry.

Their FMUs are built in a third of the time.
"""

import copy
import shutil
import tomllib
from pathlib import Path
from typing import Any

import tomli_w

from mbs.vehicle import Car, load
from mbs.vehicle.car import car_from
from mbs.vehicle.read_car import CARS

COLUMN = {
    "kind": "column",
    "rack_mass": 2.5,
    "wheel_inertia": 0.035,
    "stiffness": 115.0,
    "damping": 0.4,
    "friction": 0.2,
    "rack_friction": 120.0,
}


def rigid_car(name: str, folder: Path, **tables: Any) -> Path:
    """The file of a car in a copy of its folder, with other tables at its top."""
    shutil.copytree(CARS / name, folder)
    file = folder / "car.toml"
    data = tomllib.loads(file.read_text(encoding="utf-8"))
    data["chassis"].pop("frame", None)
    file.write_text(tomli_w.dumps(data | tables), encoding="utf-8")
    return file


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
