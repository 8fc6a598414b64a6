"""Checks of arguments of sensors: components, joints."""

from collections.abc import Sequence

from mbs.common.checks import shown
from mbs.common.errors import ModelError
from mbs.model.joints.joint import Joint
from mbs.model.register import Register

COMPONENTS = {"x": 0, "y": 1, "z": 2}


def component_number(component: str, dimension: int, what: str) -> int:
    """Number of a component. `dimension`: 2 or 3."""
    k = COMPONENTS.get(component, -1) if isinstance(component, str) else -1
    if not 0 <= k < dimension:
        names = "'x' or 'y'" if dimension == 2 else "'x', 'y' or 'z'"
        raise ModelError(f"The component of {what} is {shown(component)}; it must be {names}.")
    return k


def sensed_joint(model: Register, name: str, joint: Joint | str) -> Joint:
    """A joint of the model, for the sensor of this name."""
    sensed = model.joint_named(joint) if isinstance(joint, str) else joint
    if not isinstance(sensed, Joint) or sensed not in model.joints:
        raise ModelError(f"The sensor '{name}' needs a joint of model '{model.name}', got {shown(joint)}.")
    model.remember(sensed)
    return sensed


def sensed_joints(model: Register, name: str, argument: str, given: Sequence[Joint | str]) -> list[Joint]:
    """Several of them. `argument`: what the sensor calls them."""
    if not isinstance(given, (list, tuple)) or not given:
        raise ModelError(f"The {argument} of sensor '{name}' must be a list of joints, not {shown(given)}.")
    return [sensed_joint(model, name, joint) for joint in given]
