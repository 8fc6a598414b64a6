"""Compliance of a car's axles as rows of a text table."""

import math
from collections.abc import Mapping

from mbs.vehicle.kinematics.axle_compliance import DIRECTIONS, LOADS, Compliance

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


def rows(compliance: Compliance) -> list[tuple[str, str, str, str, str]]:
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
