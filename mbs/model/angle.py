"""Relative angle as an unwrapped coordinate: one coordinate and one row."""

import numpy as np
from numpy.typing import ArrayLike

from mbs.common.checks import direction, number
from mbs.common.errors import ModelError
from mbs.model.bodies import BodyVocabulary
from mbs.model.body import Body
from mbs.model.coordinate import Coordinate
from mbs.model.equation import AnglePart, Equation, dot_products
from mbs.model.joint_ends import different
from mbs.model.joints.joint import AngleBodies, Joint
from mbs.model.perpendicular_vectors import perpendicular


def relative_angle(
    model: BodyVocabulary, name: str, body_1: Body, body_2: Body, *, axis: ArrayLike | None = None, zero: float = 0.0
) -> Coordinate:
    """Angle of body 2 against body 1 about an axis, not wrapped, as one more coordinate.

    Parameters
    ----------
    body_1, body_2 : Body
        Bodies with axes, or the ground.
    axis : array_like, shape (3,), optional
        In space only: earth axes in the reference configuration, of any length. It is that of the hinge of the
        bodies if they have one; `compile` refuses one across it.
    zero : float
        The angle in the reference configuration, rad.

    Raises
    ------
    ModelError
        The bodies are the same or have no axes, or the axis is missing in space or given in the plane.
    """
    coordinate, joint = angle_and_joint(model, name, body_1, body_2, axis, zero)
    model._join(joint)
    return coordinate


def angle_and_joint(
    model: BodyVocabulary, name: str, body_1: Body, body_2: Body, axis: ArrayLike | None, zero: float
) -> tuple[Coordinate, Joint]:
    """A relative angle theta, which is not wrapped, and its joint, whose row is regular at every angle.

    The row is ``cos(theta) S - sin(theta) C = 0`` with C = v.e1, S = v.e2: v is a vector of body 2, e1 and e2 are
    perpendicular vectors of body 1, all perpendicular to the axis in the reference configuration, where theta is
    `zero`.
    """
    subject = f"relative angle '{name}'"
    different(body_1, body_2, subject)
    for body in (body_1, body_2):
        if model.owned(body, f"The {subject}").is_point:
            raise ModelError(f"The {subject} needs bodies with axes; '{body.name}' is a point mass.")
    if model.dimension == 2:
        if axis is not None:
            raise ModelError(f"The {subject} has an axis; in a planar model leave it out.")
        x, y = np.eye(2)
    else:
        if axis is None:
            raise ModelError(f"The {subject} needs an axis in a spatial model.")
        x, y = perpendicular(direction(axis, 3, f"the axis of {subject}"))
    start = number(zero, f"zero of {subject}")
    # in the reference configuration v is rotated by `zero` from e1
    v = body_2.vector(np.cos(start) * x + np.sin(start) * y)
    e1, e2 = body_1.vector(x), body_1.vector(y)
    theta = model.new_coordinate(name, "angle", start)
    row = Equation(name, "angle", angle=AnglePart(theta, dot_products(v, e1), dot_products(v, e2)))
    return Coordinate(name, theta, "rad"), Joint(
        name, "relative_angle", [row], turn=AngleBodies((body_1, body_2), axis, theta)
    )
