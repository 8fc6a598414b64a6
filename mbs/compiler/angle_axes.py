"""Relative angles about an axis about which the hinge of their bodies does not turn."""

import numpy as np

from mbs.common.checks import direction
from mbs.common.errors import ModelError
from mbs.model.model import Model

PERPENDICULAR = 1e-6
"""Cosine below which axes are perpendicular."""


def check_angle_axes(model: Model) -> None:
    """Raise `ModelError` for a relative angle across the hinge of its bodies.

    Such an angle stays as it is up to a quarter turn of the hinge, where its row vanishes, and is wrong beyond.
    """
    reference = model.drawn()
    hinges = [
        (set(map(id, joint.ends.bodies)), joint.name, joint.ends.axis.value(reference))
        for joint in model.joints
        if joint.type in ("revolute", "cylindrical") and joint.ends is not None and joint.ends.axis is not None
    ]
    turns = {joint.name: joint.turn for joint in model.joints if joint.turn is not None}
    for screw in (joint for joint in model.joints if joint.type == "screw"):
        turn = turns[f"{screw.name}.angle"]
        assert turn.axis is not None
        hinges.append((set(map(id, turn.bodies)), screw.name, np.asarray(turn.axis, float)))
    for angle in model.joints:
        if angle.turn is None or angle.turn.axis is None:
            continue
        axis = direction(angle.turn.axis, 3, f"the axis of relative angle '{angle.name}'")
        for bodies, name, hinge in hinges:
            if bodies == set(map(id, angle.turn.bodies)) and abs(axis @ hinge) < PERPENDICULAR * np.linalg.norm(hinge):
                raise ModelError(
                    f"The relative angle '{angle.name}' is about {_text(axis)}, but joint '{name}' between its bodies "
                    f"turns about {_text(hinge)}, perpendicular to it; give the angle the axis of the joint."
                )


def _text(axis: np.ndarray) -> str:
    return "({})".format(", ".join(f"{component + 0.0:.3g}" for component in axis))
