"""Kinematics and compliance of a car's axles: ``kinematics(load("hatchback"))`` gives its curves."""

from mbs.vehicle.kinematics.car_kinematics import Kinematics, kinematics
from mbs.vehicle.kinematics.compliance import Compliance, compliance
from mbs.vehicle.kinematics.curve_files import read_curve, write_curve
from mbs.vehicle.kinematics.curves import Curve
from mbs.vehicle.kinematics.quantities import Quantity, quantity_of

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
