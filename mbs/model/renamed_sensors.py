"""Sensors as earlier versions called them."""

from __future__ import annotations

from typing import TYPE_CHECKING, NoReturn

from mbs.model.register import Register

RENAMED = {
    "sense_velocity": "sense_position(..., order=1)",
    "sense_acceleration": "sense_position(..., order=2)",
    "sense_norm": "sense_vector(name, vector)",
    "sense_component": "sense_vector(name, vector, [axis])",
    "sense_direction": "sense_vector(name, point, [axis_1, axis_2], order=1)",
    "sense_quaternion": 'sense_rotation(name, body, "w")',
    "sense_angular_rate": "sense_rotation(name, body, component, order=1)",
    "sense_yaw": 'sense_angle(name, body, "yaw")',
    "sense_pitch": 'sense_angle(name, body, "pitch")',
    "sense_roll": 'sense_angle(name, body, "roll")',
    "sense_angle_between": "sense_angle(name, (a, b, c))",
    "sense_spin_angle": "sense_angle(name, spin)",
    "sense_recovery": "sense_coordinate(name, body.combination(weights))",
    "sense_guide_excess": 'sense_guide(name, guide, "excess")',
    "sense_guide_force": 'sense_guide(name, guide, "force")',
    "sense_joint_force": "sense_joint(name, joint, component)",
    "sense_joint_moment": 'sense_joint(name, joint, component, "moment")',
    "sense_work": 'sense_energy(name, "work", elements)',
}
"""Calls of earlier versions, and what they are now."""


class RenamedSensors(Register):
    """Says what a word that is no longer there is called now."""

    if not TYPE_CHECKING:  # for mypy a name that is not there stays an error

        def __getattr__(self, name: str) -> NoReturn:
            more = f"; it is now {RENAMED[name]}" if name in RENAMED else ""
            raise AttributeError(f"A model has no {name!r}{more}.", name=name, obj=self)
