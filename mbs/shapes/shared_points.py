"""Points that two bodies have in common through a joint, by which the pose of a body follows from its neighbours."""

import numpy as np

from mbs.common.checks import Vector
from mbs.model.joints.joint import Joint
from mbs.model.model import Model
from mbs.shapes.frames import FrameNames, numbers, place_drawn

JOINT_TYPES = ("spherical", "revolute", "universal", "weld")
"""Types of joints that constrain a common point."""
OFFSET = 0.1  # m, from the point of a joint to further common points


def shared_points(model: Model, names: FrameNames) -> list[tuple[str, list[float], str, list[float]]]:
    """Common points of all joints: for each point two frames and its coordinates in both, m.

    A joint with an axis gives two points on it, a weld three. In a flexible body the coordinates are those in its
    floating frame, without the deformation at the node. Joints that a parameter switches off are left out.
    """
    points, drawn = [], model.drawn()
    for joint in model.joints:
        ends = joint.ends
        if ends is None or joint.type not in JOINT_TYPES or joint.switch is not None:
            continue
        if any(body.is_point for body in ends.bodies):
            continue
        positions = [place_drawn(drawn, point) for point in ends.points]
        for offset in _offsets(model.dimension, drawn, joint):
            (frame_1, r_1), (frame_2, r_2) = (
                names.anchor(body, position + offset) for body, position in zip(ends.bodies, positions, strict=True)
            )
            points.append((frame_1, numbers(r_1), frame_2, numbers(r_2)))
    return points


def _offsets(dimension: int, drawn: Vector, joint: Joint) -> list[Vector]:
    """Vectors from the point of a joint to all common points of its bodies, m."""
    offsets = [np.zeros(3)]
    if joint.type == "weld":
        offsets += [OFFSET * e for e in np.eye(3)[:2]]
    elif joint.type == "revolute" and dimension == 2:
        offsets.append(np.array([0.0, 0.0, OFFSET]))
    elif joint.type == "revolute" and joint.ends is not None and joint.ends.axis is not None:
        offsets.append(OFFSET * place_drawn(drawn, joint.ends.axis))
    return offsets
