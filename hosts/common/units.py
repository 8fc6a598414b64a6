"""Units as data loggers, engineers and programs write them, in SI base units, and the units of our variables."""

import math
import re

from ali3.near_names import did_you_mean
from ali3.unit_definition import UnitDefinition
from ali3.units import OTHER_NAMES, UNITS, known_unit, plain_unit, same_quantity
from hosts.common.errors import HostError

_UNITS_OF_NAMES = (
    (r"steering_(wheel|arm)_torque|drive_torque|motor_torque|.*\.(brake_torque|M[xyz])", "N.m"),
    (r"steering_wheel_angle.*|used\.steering_wheel_angle_demand|sideslip|steering_demand_excess", "rad"),
    (r"steering_(arm|link)_angle", "rad"),
    (r"chassis\.(yaw|pitch|roll)|initial\.yaw|wheel_..\.(steer|camber|inclination|slip_angle|angle)", "rad"),
    (r"vehicle\.(steering_wheel_angle_max|front_wheel_angle_max)|anti_roll_bar_..\.angle", "rad"),
    (r"vehicle\.steering_frequency", "Hz"),
    (r"chassis\.w[xyz]|wheel_..\.omega|engine_speed|motor_speed|steering_wheel_speed|initial\.yaw_rate", "rad/s"),
    (r"speed|initial\.(lateral_)?speed|chassis\.v[xyz]", "m/s"),
    (r"chassis\.a[xyz]|accelerometer_..\.a[xyz]", "m/s2"),
    (r"chassis\.[xyz]|initial\.[xyz]|wheel_..\.(x|y|z|travel|deflection|contact_[xyz])|steering_(rack|link_[xy])", "m"),
    (r"spring_..\.length|road\.kerb_(x|height)|vehicle\.(wheelbase|track_front|track_rear|length|width)", "m"),
    (r"wheel_..\.F[xyz]|spring_..\.force|steering_rack_force|chassis\.ground_force", "N"),
    (r"energy\..*|solver\.energy_error", "J"),
    (r"stress\.SG\d+", "Pa"),
    (r"bending_moment\.SG\d+", "N.m"),
)
"""For FMUs of others, which do not declare the units of our names."""


def unit_definition(text: str, where: str) -> UnitDefinition:
    """A unit that a person or a logger has written.

    `text`: such as ``km/h``, ``°/s`` or ``[m/s^2]``; `where`: how messages call where it stands. Raises `HostError`: it
    is not known; with near ones.
    """
    result = known_unit(text)
    if result is None:
        raise HostError(
            f"{where}: the unit '{text}' is not known{did_you_mean(plain_unit(text), UNITS, closeness=0.4)} In a log "
            "another can be given by a factor: "
            "value in the log = factor * value in the FMU's unit + offset."
        )
    return result


def unit_of(name: str) -> str | None:
    """The unit of a variable of ours as FMI writes it, such as ``rad/s``; None where the name is not known."""
    return next((unit for pattern, unit in _UNITS_OF_NAMES if re.fullmatch(pattern, name)), None)


def conversion(unit: str, other: str, where: str = "the unit") -> float:
    """The factor from values in a unit to those in another.

    `unit`, `other`: as a person writes them; `where`: how messages call where `unit` stands. Raises `HostError`: one is
    not known, the two measure different quantities, or their zeros differ.
    """
    if unit == other:
        return 1.0
    first, second = unit_definition(unit, where), unit_definition(other, where)
    if not same_quantity(first, second) or first.offset != second.offset:
        raise HostError(f"{where}: values in '{unit}' cannot be converted to {other} by a factor.")
    pairs = ((unit, second), (other, first))
    turns = [math.tau if _is_hertz(name) and "rad" in of.exponents else 1.0 for name, of in pairs]
    return turns[0] * first.factor / (turns[1] * second.factor)


def _is_hertz(text: str) -> bool:
    """Whether a unit counts turns, where others count radians."""
    name = plain_unit(text)
    return OTHER_NAMES.get(name, name) == "Hz"


def is_plain_one(unit: UnitDefinition) -> bool:
    """Whether a unit is the number 1, which FMUs also declare where the unit is not known."""
    return not unit.exponents and (unit.factor, unit.offset) == (1.0, 0.0)
