"""Text table of the kinematic measures of both axles at the drawing."""

import math
from collections.abc import Sequence

from ali3.columns import in_columns
from mbs.vehicle.kinematics.car_kinematics import Kinematics
from mbs.vehicle.kinematics.compliance_table import number_text
from mbs.vehicle.kinematics.quantities import BY_NAME, Quantity

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


def quantity_and_title(name: str) -> tuple[Quantity, str]:
    """Quantity and title of a value of `Kinematics.drawn` by its name."""
    base, title = TITLED.get(name, (name, ""))
    quantity = BY_NAME[base]
    return quantity, title or quantity.title


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
            quantity, title = quantity_and_title(name)
            front, rear = (number_text(v * quantity.factor) for v in values)
            section_lines.append((title, front, rear, quantity.shown, quantity.meaning))
        if section_lines:
            lines += [(heading, "", "", "", ""), *section_lines]
    return lines


def text(lines: Sequence[tuple[str, str, str, str, str]]) -> str:
    """Text of rows. `lines`: result of `rows`."""
    lines = [("", "front", "rear", "", ""), *lines]
    headings = [bool(line[0]) and not any(line[1:]) for line in lines]
    return "\n".join("\n" * heading + line for heading, line in zip(headings, in_columns(lines, (1, 2)), strict=True))
