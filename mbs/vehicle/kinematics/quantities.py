"""Names, units and meanings of the columns of curves, in the terms of ISO 8855.

The terms are from public summaries and textbooks, not from the standard itself.
"""

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Quantity:
    """A column of a curve."""

    name: str
    """Of the column; columns of a wheel have ``_left`` or ``_right`` behind it."""
    unit: str
    """SI."""
    title: str
    shown: str
    """Unit in tables and plots for people."""
    factor: float
    """Factor from the unit to the displayed one."""
    meaning: str
    """What is positive, and against what it is measured."""


_DEG = 180.0 / math.pi


def _quantity(name: str, kind: str, title: str, meaning: str) -> Quantity:
    """Make a quantity with the units of its kind."""
    unit, shown, factor = {
        "angle": ("rad", "deg", _DEG),
        "length": ("m", "mm", 1e3),
        "size": ("m", "m", 1.0),
        "angle per travel": ("rad/m", "deg/m", _DEG),
        "length per travel": ("m/m", "mm/mm", 1.0),
        "per roll": ("rad/rad", "deg/deg", 1.0),
        "rate": ("N/m", "N/mm", 1e-3),
        "roll stiffness": ("N.m/rad", "N.m/deg", 1.0 / _DEG),
        "force": ("N", "N", 1.0),
        "percent": ("%", "%", 1.0),
        "ratio": ("rad/rad", "deg/deg", 1.0),
    }[kind]
    return Quantity(name, unit, title, shown, factor, meaning)


WHEEL = (
    _quantity("wheel_travel", "length", "wheel travel", "of the wheel centre along z, positive in bump"),
    _quantity("steer_angle", "angle", "steer angle", "about z, positive to the left"),
    _quantity("toe_angle", "angle", "toe angle", "toe-in positive"),
    _quantity("inclination_angle", "angle", "inclination angle", "against the chassis, top to the right positive"),
    _quantity("camber_angle", "angle", "camber angle", "against the chassis, positive with the top outwards"),
    _quantity("caster_angle", "angle", "caster angle", "of the steering axis, positive with the top to the rear"),
    _quantity(
        "kingpin_inclination_angle",
        "angle",
        "kingpin inclination",
        "of the steering axis, top inwards positive",
    ),
    _quantity("caster_trail", "length", "caster trail", "steering axis at the ground ahead of the contact centre"),
    _quantity(
        "kingpin_offset_at_ground",
        "length",
        "scrub radius",
        "kingpin offset at the ground, axis inboard positive",
    ),
    _quantity(
        "caster_offset_at_wheel_centre",
        "length",
        "caster offset at wheel centre",
        "steering axis at the height of the wheel centre ahead of it",
    ),
    _quantity(
        "kingpin_offset_at_wheel_centre",
        "length",
        "kingpin offset at wheel centre",
        "steering axis at the height of the wheel centre inboard of it",
    ),
    _quantity("contact_centre_x", "size", "contact centre x", "in the axes of the drawing"),
    _quantity("contact_centre_y", "size", "contact centre y", "in the axes of the drawing"),
    _quantity("contact_centre_z", "size", "contact centre z", "in the axes of the drawing"),
    _quantity("wheel_centre_x", "size", "wheel centre x", "in the axes of the drawing"),
    _quantity("wheel_centre_y", "size", "wheel centre y", "in the axes of the drawing"),
    _quantity("spring_length", "size", "spring length", "between the points of the spring"),
    _quantity("damper_length", "size", "damper length", "between the points of the damper"),
)
"""Quantities of each wheel on every curve."""

WHEEL_TRAVEL = (
    _quantity("toe_gradient", "angle per travel", "bump steer", "toe-in per travel of this wheel"),
    _quantity("camber_gradient", "angle per travel", "camber gradient", "camber angle per travel of this wheel"),
    _quantity("spring_ratio", "length per travel", "motion ratio of the spring", "compression per wheel travel"),
    _quantity("damper_ratio", "length per travel", "motion ratio of the damper", "compression per wheel travel"),
    _quantity("spring_load", "force", "load of springs and bars", "at the contact centre, without gravity"),
    _quantity("wheel_rate", "rate", "wheel rate", "load per travel of this wheel, with bars and stops"),
    _quantity("ride_rate", "rate", "wheel rate with the tyre", "wheel rate and tyre in series"),
)
"""Further quantities of each wheel on curves of wheel travel."""

AXLE = (
    _quantity("track_change", "length", "track change", "of both contact centres together, from the drawing"),
    _quantity("wheelbase_change", "length", "wheelbase change", "of the contact centres, mean of both sides"),
)
"""Quantities of the axle on every curve."""

AXLE_TRAVEL = (
    _quantity("roll_centre_height", "length", "roll centre height", "over the ground between the contact centres"),
    _quantity(
        "anti_roll_bar_ratio",
        "angle per travel",
        "motion ratio of the anti-roll bar",
        "twist per difference of the travels, in roll",
    ),
    _quantity("anti_dive", "percent", "anti-dive", "braking: share of the load transfer in the links, front"),
    _quantity("anti_lift", "percent", "anti-lift", "braking: the same behind"),
    _quantity("anti_squat", "percent", "anti-squat", "driving: the same behind"),
    _quantity("anti_lift_in_drive", "percent", "anti-lift in drive", "driving: the same in front"),
)
"""Further quantities of the axle on curves of wheel travel."""

ROLL = (
    _quantity("suspension_roll_angle", "angle", "suspension roll angle", "of the chassis, left side up positive"),
    _quantity("roll_steer", "per roll", "roll steer", "mean steer angle per suspension roll angle"),
    _quantity("roll_camber", "per roll", "roll camber", "mean inclination against the ground per roll angle"),
    _quantity("roll_stiffness", "roll stiffness", "suspension roll stiffness", "moment per suspension roll angle"),
)
"""Further quantities of the axle on curves of opposite travel."""

STEER = (
    _quantity("steering_wheel_angle", "angle", "steering-wheel angle", "positive to the left"),
    _quantity("rack_travel", "length", "rack travel", "positive to the left"),
    _quantity("steering_arm_angle", "angle", "angle of the Pitman arm", "positive if it steers to the left"),
    _quantity("mean_steer_angle", "angle", "mean steer angle", "of both wheels"),
    _quantity("steering_ratio", "ratio", "steering ratio", "steering-wheel angle per mean steer angle"),
    _quantity("ackermann_steer_angle", "angle", "Ackermann steer angle, outer wheel", "for that of the inner"),
    _quantity("ackermann_error", "angle", "Ackermann error", "size of the outer wheel's steer angle less Ackermann's"),
    _quantity("ackermann", "percent", "Ackermann", "difference of the steer angles over that of Ackermann's"),
    _quantity(
        "turning_circle",
        "size",
        "turning circle",
        "diameter of the path of the outer front contact centre without slip",
    ),
)
"""Further quantities of the axle on curves of steering."""

BY_NAME = {q.name: q for group in (WHEEL, WHEEL_TRAVEL, AXLE, AXLE_TRAVEL, ROLL, STEER) for q in group}
"""All quantities by name."""


def quantity_of(column: str) -> Quantity:
    """The quantity of a column.

    Parameters
    ----------
    column : str
        Its name, with or without ``_left`` or ``_right``.
    """
    return BY_NAME[column.removesuffix("_left").removesuffix("_right")]
