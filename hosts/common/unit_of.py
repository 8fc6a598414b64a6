"""The SI units of our names of variables, for FMUs that do not tell theirs or have others."""

from __future__ import annotations

import re

_UNITS = (
    (r"steering_wheel_torque|drive_torque|motor_torque|.*\.(brake_torque|M[xyz])", "N.m"),
    (r"steering_wheel_angle.*|used\.steering_wheel_angle_demand|sideslip|steering_demand_excess", "rad"),
    (r"chassis\.(yaw|pitch|roll)|initial\.yaw|wheel_..\.(steer|camber|inclination|slip_angle|angle)", "rad"),
    (r"vehicle\.(steering_wheel_angle_max|front_wheel_angle_max)|anti_roll_bar_..\.angle", "rad"),
    (r"chassis\.w[xyz]|wheel_..\.omega|engine_speed|motor_speed|steering_wheel_speed", "rad/s"),
    (r"speed|initial\.speed|chassis\.v[xyz]", "m/s"),
    (r"chassis\.a[xyz]|accelerometer_..\.a[xyz]", "m/s2"),
    (r"chassis\.[xyz]|initial\.[xyz]|wheel_..\.(x|y|z|travel|deflection|contact_[xyz])|steering_rack", "m"),
    (r"spring_..\.length|road\.kerb_(x|height)|vehicle\.(wheelbase|track_front|track_rear|length|width)", "m"),
    (r"wheel_..\.F[xyz]|spring_..\.force|steering_rack_force|chassis\.ground_force", "N"),
    (r"energy\..*|solver\.energy_error", "J"),
    (r"stress\.SG\d+", "Pa"),
    (r"bending_moment\.SG\d+", "N.m"),
)


def unit_of(name: str) -> str | None:
    """The unit of a variable of ours as FMI writes it, such as ``rad/s``; None where the name is not known."""
    return next((unit for pattern, unit in _UNITS if re.fullmatch(pattern, name)), None)
