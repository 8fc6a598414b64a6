"""Checks whether an FMU is a car that can be driven; if not, says why."""

from collections.abc import Collection, Sequence
from pathlib import Path

from ali3.columns import some_of

STEERING = ("steering", "steering_wheel_angle_demand", "steering_torque")
"""Any of them steers."""
PEDALS = ("throttle", "brake")
POSE = ("chassis.x", "chassis.y", "chassis.z", "chassis.yaw")


def lacking(inputs: Collection[str], outputs: Collection[str]) -> tuple[list[str], list[str]]:
    """Inputs and outputs that driving needs and that are not there."""
    steers = [] if any(name in inputs for name in STEERING) else [STEERING[0]]
    pedals = [name for name in PEDALS if name not in inputs]
    return steers + pedals, [name for name in POSE if name not in outputs]


def not_drivable(path: Path, inputs: Sequence[str], outputs: Sequence[str], has_drawing: bool) -> str:
    """What an FMU lacks to be driven, what would help, and what works without; empty where nothing is lacking.

    `inputs`, `outputs`: names, after aliases.
    """
    no_inputs, no_outputs = lacking(inputs, outputs)
    lacks = [f"no input {', '.join(no_inputs)}"] if no_inputs else []
    lacks += [f"no output {', '.join(no_outputs)}"] if no_outputs else []
    if not lacks:
        return ""
    subject = "its inputs that have our names can be moved; it" if len(no_inputs) < len(PEDALS) + 1 else "it"
    picture = "" if has_drawing else ", but is not drawn, since it has no drawing"
    return (
        f"{path.name} has {' and '.join(lacks)}, which driving needs. If it has them under other names, an alias file "
        f"says so (--aliases FILE). Its inputs are {some_of(inputs)}; its outputs {some_of(outputs)}. As it is, "
        f"{subject} runs, can be paused, slowed down, reset and recorded{picture}."
    )
