"""Kinematics and compliance of a car's axles: ``kinematics(load("hatchback"))`` gives its curves."""

from typing import TYPE_CHECKING

from mbs.common.lazy_modules import lazy_modules

if TYPE_CHECKING:
    from mbs.vehicle.kinematics.axle_compliance import Compliance, compliance
    from mbs.vehicle.kinematics.car_kinematics import Kinematics, kinematics
    from mbs.vehicle.kinematics.curve_files import read_curve, write_curve
    from mbs.vehicle.kinematics.curves import Curve
    from mbs.vehicle.kinematics.quantities import Quantity, quantity_of

# imported on first use: the reader of cars computes measures, and these modules import the car
_NAMES_BY_MODULE = {
    "car_kinematics": ("Kinematics", "kinematics"),
    "axle_compliance": ("Compliance", "compliance"),
    "curve_files": ("read_curve", "write_curve"),
    "curves": ("Curve",),
    "quantities": ("Quantity", "quantity_of"),
}
__getattr__ = lazy_modules(
    __name__, (), {name: f"{__name__}.{module}" for module, names in _NAMES_BY_MODULE.items() for name in names}
)

__all__ = [
    "Compliance",
    "Curve",
    "Kinematics",
    "Quantity",
    "compliance",
    "kinematics",
    "quantity_of",
    "read_curve",
    "write_curve",
]
