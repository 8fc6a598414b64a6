"""Cars as files: ``load("prototype")``, or the path of your own car.toml, gives a `Car`; its `model` the `Model`."""

from typing import TYPE_CHECKING

from mbs.common.lazy_modules import lazy_modules

if TYPE_CHECKING:
    from mbs.vehicle import kinematics as kinematics
    from mbs.vehicle.car import Car
    from mbs.vehicle.errors import CarFileError, CarWarning
    from mbs.vehicle.fidelity import Fidelity
    from mbs.vehicle.read_car import car_names, load
    from mbs.vehicle.schema import json_schema

# imported when they are first asked for: the help of the command needs no engine
_LAZY = {
    "Car": "mbs.vehicle.car",
    "CarFileError": "mbs.vehicle.errors",
    "CarWarning": "mbs.vehicle.errors",
    "Fidelity": "mbs.vehicle.fidelity",
    "car_names": "mbs.vehicle.read_car",
    "json_schema": "mbs.vehicle.schema",
    "load": "mbs.vehicle.read_car",
}
__getattr__ = lazy_modules(__name__, ("kinematics",), _LAZY)

__all__ = ["Car", "CarFileError", "CarWarning", "Fidelity", "car_names", "json_schema", "load"]
