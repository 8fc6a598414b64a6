"""The universal joint."""

import numpy as np
from numpy.typing import ArrayLike

from mbs.common.affine import Affine
from mbs.common.checks import direction
from mbs.common.errors import ModelError
from mbs.model.bodies import BodyVocabulary
from mbs.model.body import Body
from mbs.model.equation import Equation, dot_products
from mbs.model.joint_ends import PointPair, different
from mbs.model.joint_rotation import RotationConditions
from mbs.model.joints.joint import Drawing, Joint, JointEnds, point_pair
from mbs.model.joints.points import joint_points, shared_point

_PARALLEL = 1.0 - 1e-12
"""Cosine of the angle from which axes are parallel."""


def universal(
    model: BodyVocabulary,
    name: str,
    body_1: Body,
    body_2: Body,
    *,
    point: PointPair,
    axis_1: ArrayLike,
    axis_2: ArrayLike,
) -> Joint:
    """Universal joint: the bodies share a point, and the angle between an axis of each is constant.

    Parameters
    ----------
    body_1, body_2 : Body
        Bodies, the ground, or nodes of flexible bodies of a spatial model.
    point : array_like, shape (3,), or pair of them
        Earth axes in the reference configuration, m; a pair is one point per body.
    axis_1, axis_2 : array_like, shape (3,)
        Axis fixed in body 1 and axis fixed in body 2, of any length and not parallel.

    Raises
    ------
    ModelError
        The model is planar, the bodies are the same, or the axes are parallel.
    """
    subject = f"universal joint '{name}'"
    if model.dimension == 2:
        raise ModelError(f"The {subject} needs a spatial model; this one has dimension 2.")
    different(body_1, body_2, subject)
    p1, p2 = point_pair(point, model.dimension, subject)
    body_1, body_2 = body_1.at(p1, subject), body_2.at(p2, subject)
    u1, u2 = direction(axis_1, 3, f"axis_1 of {subject}"), direction(axis_2, 3, f"axis_2 of {subject}")
    cosine = float(np.dot(u1, u2))
    if abs(cosine) > _PARALLEL:
        raise ModelError(f"The axes of {subject} are parallel; a universal joint needs two different directions.")
    a1, a2 = model.anchor_axis(body_1, u1, subject), model.anchor_axis(body_2, u2, subject)
    equations = shared_point(model, name, body_1, body_2, point, subject)
    equations.append(Equation(name, "axes", dot_products(a1, a2), Affine({}, -cosine)))
    turning = lambda: RotationConditions(joint_points(body_1, p1, body_2, p2), [(a1, a2, cosine)])  # noqa: E731
    joint = Joint(name, "universal", equations, rows_weight=1.0, turning=turning)
    joint.ends = JointEnds((body_1, body_2), (body_1.point(p1), body_2.point(p2)))

    def remake(point: PointPair, axes: tuple[ArrayLike, ArrayLike] | None, _: float) -> Joint:
        first, second = axes or (u1, u2)
        return universal(model, name, body_1, body_2, point=point, axis_1=first, axis_2=second)

    joint.drawing = Drawing(
        (body_1, body_2),
        (p1, p2),
        (u1, u2),
        ("point", "angle"),
        remake,
    )
    return joint
