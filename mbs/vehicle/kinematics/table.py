"""Rows of text tables: kinematic measures of both axles at the drawing, and their compliance."""

import math
from collections.abc import Mapping, Sequence

from ali3.columns import in_columns
from mbs.vehicle.kinematics.axle_compliance import DIRECTIONS, LOADS, Compliance
from mbs.vehicle.kinematics.car_kinematics import Kinematics
from mbs.vehicle.kinematics.quantities import BY_NAME

TITLED = {
    "right_toe_angle": ("toe_angle", "toe angle, right wheel"),
    "right_camber_angle": ("camber_angle", "camber angle, right wheel"),
    "lock_steering_wheel_angle": ("steering_wheel_angle", "steering-wheel angle at full lock"),
    "lock_inner": ("steer_angle", "steer angle, inner wheel, at full lock"),
    "lock_outer": ("steer_angle", "steer angle, outer wheel, at full lock"),
    "lock_ackermann": ("ackermann", "Ackermann at full lock"),
    "lock_ackermann_error": ("ackermann_error", "Ackermann error at full lock"),
    "lock_turning_circle": ("turning_circle", "turning circle (outer front contact centre)"),
    "roll_wheel_rate": ("wheel_rate", "wheel rate in roll, with the anti-roll bar"),
}
SECTIONS = (
    ("At the drawing", (
        "toe_angle", "right_toe_angle", "camber_angle", "right_camber_angle", "caster_angle",
        "kingpin_inclination_angle", "caster_trail", "kingpin_offset_at_ground",
        "caster_offset_at_wheel_centre", "kingpin_offset_at_wheel_centre",
    )),
    ("Parallel wheel travel", (
        "toe_gradient", "camber_gradient", "roll_centre_height", "anti_dive", "anti_lift", "anti_squat",
        "anti_lift_in_drive", "spring_ratio", "damper_ratio", "spring_load", "wheel_rate", "ride_rate",
    )),
    ("Roll", ("roll_steer", "roll_camber", "anti_roll_bar_ratio", "roll_wheel_rate", "roll_stiffness")),
    ("Steering", ("steering_ratio", *(name for name in TITLED if name.startswith("lock")))),
)  # fmt: skip
"""Headings with the names of their rows."""
_DEG = 180.0 / math.pi
_FORCE = {"angle": (1e3 * _DEG, "deg/kN"), "shift": (1e6, "mm/kN")}
_TORQUE = {"angle": (100.0 * _DEG, "deg/100 N.m"), "shift": (1e5, "mm/100 N.m")}
_WORDS = {
    "lateral_force": "lateral force",
    "longitudinal_force": "longitudinal force at the contact",
    "drive_force": "longitudinal force at the wheel centre",
    "aligning_torque": "aligning torque",
}
_SENSE = {"same": "both wheels alike", "opposed": "right wheel opposed"}
_DISPLACEMENTS: Mapping[str, tuple[tuple[str, str, str], ...]] = {
    "lateral_force": (("contact_y", "shift", "contact centre to the left"),),
    "longitudinal_force": (("centre_x", "shift", "wheel centre forwards"),),
}
_ANGLES = (
    ("steer_angle", "angle", "steer angle, left positive"),
    ("inclination_angle", "angle", "inclination angle, top to the right positive"),
)


def rows(kinematics: Kinematics) -> list[tuple[str, str, str, str, str]]:
    """Title, value at the front axle, value at the rear axle, unit and meaning; a title alone is a heading."""
    drawn = {axle: kinematics.drawn(axle) for axle in ("front", "rear")}
    lines = []
    for heading, names in SECTIONS:
        section_lines = []
        for name in names:
            values = [drawn[axle].get(name, math.nan) for axle in drawn]
            if all(math.isnan(v) for v in values):
                continue
            base, title = TITLED.get(name, (name, ""))
            quantity = BY_NAME[base]
            front, rear = (number_text(v * quantity.factor) for v in values)
            section_lines.append((title or quantity.title, front, rear, quantity.shown, quantity.meaning))
        if section_lines:
            lines += [(heading, "", "", "", ""), *section_lines]
    return lines


def compliance_rows(compliance: Compliance) -> list[tuple[str, str, str, str, str]]:
    """Rows of a text table.

    Returns
    -------
    list of (str, str, str, str, str)
        Title, value at the front axle, value at the rear axle, unit and meaning; a title alone is a heading.
    """
    title = f"Compliance of the left wheel per load (fidelity {compliance.fidelity.value})"
    lines: list[tuple[str, str, str, str, str]] = [(title, "", "", "", "")]
    for load in LOADS if compliance.freedoms else ():
        units = _TORQUE if load == "aligning_torque" else _FORCE
        for sense in DIRECTIONS:
            for name, kind, meaning in (*_ANGLES, *_DISPLACEMENTS.get(load, ())):
                factor, unit = units[kind]
                front, rear = _axle_cells(compliance, f"{load}.{sense}.{name}", factor)
                lines.append((f"{_WORDS[load]}, {_SENSE[sense]}", front, rear, unit, meaning))
    for name, words in (("wheel_rate", "wheel rate with what gives"), ("roll_wheel_rate", "the same in roll")):
        front, rear = _axle_cells(compliance, name, 1e-3)
        lines.append((words, front, rear, "N/mm", "load per travel, frame or column in series"))
    return lines


def _axle_cells(compliance: Compliance, name: str, factor: float) -> tuple[str, str]:
    """Value times a factor at the front and the rear axle, as text."""
    front, rear = (factor * compliance.values.get(axle, {}).get(name, math.nan) for axle in ("front", "rear"))
    return number_text(front), number_text(rear)


def number_text(value: float) -> str:
    """Text of a value with four digits; a dash for NaN, and 0 for round-off."""
    if math.isnan(value):
        return "-"
    return f"{value:.0f}" if abs(value) >= 1e4 else f"{round(value, 6) + 0.0:.4g}"


def text(lines: Sequence[tuple[str, str, str, str, str]]) -> str:
    """Text of rows. `lines`: result of `rows`."""
    lines = [("", "front", "rear", "", ""), *lines]
    headings = [bool(line[0]) and not any(line[1:]) for line in lines]
    return "\n".join("\n" * heading + line for heading, line in zip(headings, in_columns(lines, (1, 2)), strict=True))
