"""Points that two bodies share by their joints: from them the pose of a body follows from those of its neighbours."""

import numpy as np

from mbs.common.checks import Vector
from mbs.model.joints.joint import Joint
from mbs.model.model import Model
from mbs.shapes.frames import FrameNames, numbers, place_drawn

JOINTS = ("spherical", "revolute", "universal", "weld")
"""Types of joints whose bodies have a point in common."""
ALONG = 0.1  # m, from the point of a joint to others that its bodies share


def shared_points(model: Model, names: FrameNames) -> list[tuple[str, list[float], str, list[float]]]:
    """For each such point the two frames and its place in both, from their origins along their axes, m.

    A joint with an axis gives two points of it, a weld three. Of a body that bends it is the place in its floating
    frame, from which a node is away by what it bends. Joints that a parameter takes away stay out.
    """
    found, drawn = [], model.drawn()
    for joint in model.joints:
        ends = joint.ends
        if ends is None or joint.type not in JOINTS or joint.switch is not None:
            continue
        if any(body.is_point for body in ends.bodies):
            continue
        places = [place_drawn(drawn, point) for point in ends.points]
        for way in _ways(model.dimension, drawn, joint):
            one, two = (names.anchor(body, place + way) for body, place in zip(ends.bodies, places, strict=True))
            found.append((one[0], numbers(one[1]), two[0], numbers(two[1])))
    return found


def _ways(dimension: int, drawn: Vector, joint: Joint) -> list[Vector]:
    """From the point of a joint to all that its bodies share."""
    ways = [np.zeros(3)]
    if joint.type == "weld":
        ways += [ALONG * e for e in np.eye(3)[:2]]
    elif joint.type == "revolute" and dimension == 2:
        ways.append(np.array([0.0, 0.0, ALONG]))
    elif joint.type == "revolute" and joint.ends is not None and joint.ends.axis is not None:
        ways.append(ALONG * place_drawn(drawn, joint.ends.axis))
    return ways
