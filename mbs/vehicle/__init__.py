"""Cars as files: ``load("prototype")``, or the path of your own car.toml, gives a `Car`; its `model` the `Model`."""

from typing import TYPE_CHECKING

from mbs.common.lazy_modules import lazy_modules
from mbs.vehicle.car import Car
from mbs.vehicle.car_file import car_names, load
from mbs.vehicle.errors import CarFileError, CarWarning
from mbs.vehicle.fidelity import Fidelity
from mbs.vehicle.json_schema import json_schema

if TYPE_CHECKING:
    from mbs.vehicle import kinematics as kinematics

__getattr__ = lazy_modules(__name__, ("kinematics",))

__all__ = ["Car", "CarFileError", "CarWarning", "Fidelity", "car_names", "json_schema", "load"]
