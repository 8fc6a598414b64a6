"""Checks of arguments of sensors: components, joints."""

from collections.abc import Sequence

from mbs.common.checks import shown
from mbs.common.errors import ModelError
from mbs.model.joints.joint import Joint
from mbs.model.register import Register

COMPONENTS = {"x": 0, "y": 1, "z": 2}


def component_number(component: str, dimension: int, subject: str) -> int:
    """Index of a component, "x", "y" or "z"; `dimension`: 2 or 3."""
    k = COMPONENTS.get(component, -1) if isinstance(component, str) else -1
    if not 0 <= k < dimension:
        names = "'x' or 'y'" if dimension == 2 else "'x', 'y' or 'z'"
        raise ModelError(f"The component of {subject} is {shown(component)}; it must be {names}.")
    return k


def sensed_joint(model: Register, name: str, joint: Joint | str) -> Joint:
    """The joint of a sensor, itself or by its name; raises `ModelError` if it is not of the model."""
    sensed = model.joint_named(joint) if isinstance(joint, str) else joint
    if not isinstance(sensed, Joint) or sensed not in model.joints:
        raise ModelError(f"The sensor '{name}' needs a joint of model '{model.name}', got {shown(joint)}.")
    model.remember(sensed)
    return sensed


def sensed_joints(model: Register, name: str, argument: str, joints: Sequence[Joint | str]) -> list[Joint]:
    """The joints of a sensor; `argument`: name of the argument, for errors."""
    if not isinstance(joints, (list, tuple)) or not joints:
        raise ModelError(f"The {argument} of sensor '{name}' must be a list of joints, not {shown(joints)}.")
    return [sensed_joint(model, name, joint) for joint in joints]
