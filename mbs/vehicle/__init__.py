"""Cars as files: ``load("prototype")``, or the path of your own car.toml, gives a `Car`; its `model` the `Model`."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from mbs.common.lazy_modules import lazy_modules

if TYPE_CHECKING:
    from mbs.vehicle import kinematics as kinematics
    from mbs.vehicle.car import Car
    from mbs.vehicle.car_file import car_names, load
    from mbs.vehicle.errors import CarFileError, CarWarning
    from mbs.vehicle.fidelity import Fidelity
    from mbs.vehicle.schema import json_schema

_package = lazy_modules(__name__, ("kinematics",))
# imported when they are first asked for: the help of the command needs no engine
_LAZY = {
    "Car": "mbs.vehicle.car",
    "CarFileError": "mbs.vehicle.errors",
    "CarWarning": "mbs.vehicle.errors",
    "Fidelity": "mbs.vehicle.fidelity",
    "car_names": "mbs.vehicle.car_file",
    "json_schema": "mbs.vehicle.schema",
    "load": "mbs.vehicle.car_file",
}

__all__ = ["Car", "CarFileError", "CarWarning", "Fidelity", "car_names", "json_schema", "load"]


def __getattr__(name: str) -> Any:
    return getattr(import_module(_LAZY[name]), name) if name in _LAZY else _package(name)
