"""Mimic joints of a URDF file, whose value is a linear function of the value of another joint."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Any

from mbs.common.errors import ModelError


@dataclass(frozen=True)
class MimicJoint:
    """A joint whose value is `multiplier` times its leader's plus `offset`; rad or m."""

    name: str
    leader: str
    multiplier: float
    offset: float


def read_mimic_joints(joints: Mapping[str, Any], prescribed: Collection[str], file_name: str) -> dict[str, MimicJoint]:
    """Mimic joints by name, each after its leader.

    `joints`: moving joints by name; `prescribed`: joints with a value or a motion of the user; `file_name`: for
    messages. Raises `ModelError` if a leader is missing or does not move, joints follow each other in a cycle, a
    multiplier is zero, or a mimic joint is prescribed.
    """
    pending: dict[str, MimicJoint] = {}
    for name, joint in joints.items():
        mimic = joint.mimic
        if mimic is None:
            continue
        subject = f"{file_name}: the joint '{name}' follows '{mimic.joint}' (mimic)"
        if mimic.joint not in joints:
            raise ModelError(f"{subject}, which is not a moving joint; these are {', '.join(joints)}.")
        if name in prescribed:
            raise ModelError(f"{subject} and is given a place or a motion; give it to '{mimic.joint}'.")
        multiplier = 1.0 if mimic.multiplier is None else float(mimic.multiplier)
        if multiplier == 0.0:
            raise ModelError(f"{subject} with a multiplier of 0; make it a fixed joint.")
        pending[name] = MimicJoint(name, mimic.joint, multiplier, float(mimic.offset or 0.0))
    ordered: dict[str, MimicJoint] = {}
    while pending:
        ready = {n: f for n, f in pending.items() if f.leader not in pending}
        if not ready:
            raise ModelError(f"{file_name}: the joints {', '.join(pending)} follow each other in a ring (mimic).")
        ordered |= ready
        pending = {n: f for n, f in pending.items() if n not in ready}
    return ordered


def mimic_values(followers: Mapping[str, MimicJoint], at: Mapping[str, float]) -> dict[str, float]:
    """Values of mimic joints, rad or m. `at`: values of joints by name; missing ones are 0."""
    values = dict(at)
    for name, joint in followers.items():
        values[name] = joint.multiplier * values.get(joint.leader, 0.0) + joint.offset
    return {name: values[name] for name in followers}
