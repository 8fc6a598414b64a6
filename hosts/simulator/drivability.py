"""Checks whether an FMU is a car that can be driven."""

from collections.abc import Collection, Sequence
from pathlib import Path

from ali3.columns import some_of

STEERING = ("steering", "steering_wheel_angle_demand", "steering_torque")
"""Inputs of which one is needed for steering."""
PEDALS = ("throttle", "brake")
POSE = ("chassis.x", "chassis.y", "chassis.z", "chassis.yaw")


def missing_variables(inputs: Collection[str], outputs: Collection[str]) -> tuple[list[str], list[str]]:
    """Missing inputs and outputs that driving needs."""
    steering = [] if any(name in inputs for name in STEERING) else [STEERING[0]]
    pedals = [name for name in PEDALS if name not in inputs]
    return steering + pedals, [name for name in POSE if name not in outputs]


def not_drivable(path: Path, inputs: Sequence[str], outputs: Sequence[str], has_drawing: bool) -> str:
    """Sentences on what an FMU lacks to be driven, a remedy, and what works without; empty if nothing is missing.

    `inputs`, `outputs`: ALi3 names, after aliases.
    """
    missing_inputs, missing_outputs = missing_variables(inputs, outputs)
    lacks = [f"no input {', '.join(missing_inputs)}"] if missing_inputs else []
    lacks += [f"no output {', '.join(missing_outputs)}"] if missing_outputs else []
    if not lacks:
        return ""
    subject = "its inputs that have ALi3 names can be moved; it" if len(missing_inputs) < len(PEDALS) + 1 else "it"
    picture = "" if has_drawing else ", but is not drawn, since it has no drawing"
    return (
        f"{path.name} has {' and '.join(lacks)}, which driving needs. If it has them under other names, an alias file "
        f"says so (--aliases FILE). Its inputs are {some_of(inputs)}; its outputs {some_of(outputs)}. As it is, "
        f"{subject} runs, can be paused, slowed down, reset and recorded{picture}."
    )
