"""The prismatic joint, and conditions of equal orientation."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from mbs.common.errors import ModelError
from mbs.model.bodies import BodyVocabulary
from mbs.model.body import Body
from mbs.model.equation import Equation, dot_products
from mbs.model.joint_ends import PointPair, different
from mbs.model.joint_rotation import RotationConditions
from mbs.model.joints.joint import Drawing, Joint, JointPlaces, equal_vectors, point_pair
from mbs.model.joints.points import can_share_vectors, joint_points
from mbs.model.joints.sliding import on_line, sliding_ends


def same_orientation(model: BodyVocabulary, name: str, body_1: Body, body_2: Body, subject: str) -> list[Equation]:
    """Equations of equal orientation: all axes are shared (linear); of nodes that bend, their directions."""
    axes = np.eye(model.dimension)[: 1 if model.dimension == 2 else 3]
    for body in (body_1, body_2):
        if model.owned(body, f"The {subject}").is_point:
            raise ModelError(f"The {subject} needs bodies with axes; '{body.name}' is a point mass.")
    if can_share_vectors(body_1, body_2):
        return [e for u in axes for e in equal_vectors(name, "axis", body_1.vector(u), body_2.vector(u))]
    if body_2.bends and not body_1.bends:
        body_1, body_2 = body_2, body_1
    first = [model.anchor_axis(body_1, u, subject) for u in axes[:2]]
    second = [model.anchor_axis(body_2, u, subject) for u in axes[1:]]
    pairs = ((first[0], second[0]), (first[0], second[1]), (first[1], second[1]))
    return [Equation(name, "axis", dot_products(u, v)) for u, v in pairs]


def orientation_conditions(body_1: Body, p1: ArrayLike, body_2: Body, p2: ArrayLike) -> RotationConditions:
    """Conditions that keep axes of body 1 perpendicular to other axes of body 2."""
    axes = np.eye(len(body_1.com))
    pairs = [(0, 1)] if len(axes) == 2 else [(0, 1), (0, 2), (1, 2)]
    vectors = [(body_1.vector(axes[i]), body_2.vector(axes[j]), 0.0) for i, j in pairs]
    return RotationConditions(joint_points(body_1, p1, body_2, p2), vectors)


def prismatic(
    model: BodyVocabulary, name: str, body_1: Body, body_2: Body, *, axis: ArrayLike, point: PointPair | None = None
) -> Joint:
    """Prismatic joint: the bodies share their orientation, and body 1 slides along an axis of body 2.

    Parameters
    ----------
    body_1, body_2 : Body
        Bodies, the ground, or nodes of flexible bodies.
    axis : array_like, shape (dimension,)
        Direction of the slide, fixed in body 2, of any length.
    point : array_like, shape (dimension,), or pair of them, optional
        Point of body 1 on the axis, m; by default the centre of mass of body 1, of body 2 where body 1 is the
        ground.

    Raises
    ------
    ModelError
        The bodies are the same or have no axes.
    """
    subject = f"prismatic joint '{name}'"
    different(body_1, body_2, subject)
    if point is None:
        point = body_2.com if body_1.is_ground else body_1.com
    p1, p2 = point_pair(point, model.dimension, subject)
    equations = same_orientation(model, name, body_1, body_2, subject)
    line, normals = on_line(model, name, (body_1, p1), (body_2, p2), axis, subject)
    places = JointPlaces((body_1, body_2), (p1, p2), (axis, axis))
    turning = lambda: orientation_conditions(body_1, p1, body_2, p2)  # noqa: E731
    joint = Joint(name, "prismatic", equations + line, normals=normals, places=places, turning=turning)
    joint.ends = sliding_ends((body_1, p1), (body_2, p2), axis, subject)
    joint.drawing = Drawing(
        (body_1, body_2),
        (p1, p2),
        (axis, axis),
        ("orientation", "line"),
        lambda p, u, _: prismatic(model, name, body_1, body_2, point=p, axis=(u or (axis, axis))[1]),
    )
    return joint
