"""Joints of a URDF file that follow others: ``mimic``."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Any

from mbs.common.errors import ModelError


@dataclass(frozen=True)
class MimicJoint:
    """A joint whose value is `multiplier` times that of its leader plus `offset`; rad or m."""

    name: str
    leader: str
    multiplier: float
    offset: float


def mimic_joints_of(joints: Mapping[str, Any], prescribed: Collection[str], what: str) -> dict[str, MimicJoint]:
    """The joints that follow others, by their names, each after those that it follows.

    `prescribed`: joints that the user places or moves; `what`: the robot, for messages. Raises `ModelError`: one
    follows a joint that does not move or is not there, or itself; its multiplier is zero; it is prescribed.
    """
    pending: dict[str, MimicJoint] = {}
    for name, joint in joints.items():
        mimic = joint.mimic
        if mimic is None:
            continue
        subject = f"{what}: the joint '{name}' follows '{mimic.joint}' (mimic)"
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
            raise ModelError(f"{what}: the joints {', '.join(pending)} follow each other in a ring (mimic).")
        ordered |= ready
        pending = {n: f for n, f in pending.items() if n not in ready}
    return ordered


def start_of(followers: Mapping[str, MimicJoint], at: Mapping[str, float]) -> dict[str, float]:
    """Values of the joints that follow others, rad or m. `at`: values of joints by name; those left out are 0."""
    values = dict(at)
    for name, f in followers.items():
        values[name] = f.multiplier * values.get(f.leader, 0.0) + f.offset
    return {name: values[name] for name in followers}
