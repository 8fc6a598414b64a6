"""Equations of joints that slide along a line, the point-on-line and the cylindrical joint."""

import numpy as np
from numpy.typing import ArrayLike

from mbs.common.affine import AffineVector
from mbs.common.checks import direction
from mbs.common.errors import ModelError
from mbs.model.bodies import BodyVocabulary
from mbs.model.body import Body
from mbs.model.equation import Equation, dot_products
from mbs.model.joint_ends import PointPair, body_and_point, different
from mbs.model.joints.joint import Drawing, Joint, JointEnds, point_pair
from mbs.model.joints.points import axis_conditions, shared_axis
from mbs.model.perpendicular_vectors import perpendicular


def _normals(model: BodyVocabulary, body: Body, axis: ArrayLike, subject: str) -> list[AffineVector]:
    """Vectors of `body` that are perpendicular to the axis: one in the plane, two in space."""
    if model.dimension == 2:
        u = direction(axis, 2, f"the axis of {subject}")
        return [model.anchor_axis(body, np.array([-u[1], u[0]]), subject)]
    return [model.anchor_axis(body, e, subject) for e in perpendicular(direction(axis, 3, f"the axis of {subject}"))]


def on_line(
    model: BodyVocabulary,
    name: str,
    end_1: tuple[Body, ArrayLike],
    end_2: tuple[Body, ArrayLike],
    axis: ArrayLike,
    subject: str,
) -> tuple[list[Equation], list[AffineVector]]:
    """Equations that keep the point of body 1 on the line through the point of body 2 along an axis of body 2, and
    the normals of the line.
    """
    body_2 = model.owned(end_2[0], f"The {subject}")
    if body_2.is_point:
        raise ModelError(f"The line of {subject} needs a body with axes; '{body_2.name}' is a point mass.")
    gap = model.anchor(end_1[0], end_1[1], subject) - model.anchor(body_2, end_2[1], subject)
    normals = _normals(model, body_2, axis, subject)
    return [Equation(name, "line", dot_products(gap, n)) for n in normals], normals


def sliding_ends(
    end_1: tuple[Body, ArrayLike], end_2: tuple[Body, ArrayLike], axis: ArrayLike, subject: str
) -> JointEnds:
    """Ends of a joint whose point of body 1 slides along an axis of body 2."""
    (body_1, p1), (body_2, p2) = end_1, end_2
    # a vector of a node that bends would need additional rows
    axis_body = body_2.owner if body_2.bends else body_2
    axis_vector = axis_body.vector(direction(axis, body_2.dimension, f"the axis of {subject}"))
    return JointEnds((body_1, body_2), (body_1.point(p1), body_2.point(p2)), axis_vector, slides=True)


def point_on_line(
    model: BodyVocabulary, name: str, end_1: tuple[Body, ArrayLike], end_2: tuple[Body, ArrayLike], *, axis: ArrayLike
) -> Joint:
    """A point of body 1 stays on a line fixed in body 2.

    Parameters
    ----------
    end_1 : (Body, array_like of shape (dimension,))
        Body 1 and its point, m.
    end_2 : (Body, array_like of shape (dimension,))
        Body 2 and a point of the line, m.
    axis : array_like, shape (dimension,)
        Direction of the line, fixed in body 2, of any length.

    Raises
    ------
    ModelError
        The bodies are the same, or body 2 is a point mass.
    """
    subject = f"point-on-line joint '{name}'"
    end_1, end_2 = (body_and_point(end, subject, "(body, point)") for end in (end_1, end_2))
    different(end_1[0], end_2[0], subject)
    line, normals = on_line(model, name, end_1, end_2, axis, subject)
    joint = Joint(name, "point_on_line", line, normals=normals)
    joint.ends = sliding_ends(end_1, end_2, axis, subject)
    joint.drawing = Drawing(
        (end_1[0], end_2[0]),
        (end_1[1], end_2[1]),
        (axis, axis),
        ("line",),
        lambda p, u, _: point_on_line(model, name, (end_1[0], p[0]), (end_2[0], p[1]), axis=(u or (axis, axis))[1]),
    )
    return joint


def cylindrical(
    model: BodyVocabulary, name: str, body_1: Body, body_2: Body, *, point: PointPair, axis: PointPair
) -> Joint:
    """Cylindrical joint: the bodies share an axis, along which they slide and about which they turn.

    Parameters
    ----------
    body_1, body_2 : Body
        Bodies, the ground, or nodes of flexible bodies of a spatial model.
    point : array_like, shape (3,), or pair of them
        Point of body 1 on the axis of body 2, m.
    axis : array_like, shape (3,), or pair of them
        Of any length; a pair is one axis per body.

    Raises
    ------
    ModelError
        The model is planar, or the bodies are the same.
    """
    subject = f"cylindrical joint '{name}'"
    if model.dimension == 2:
        raise ModelError(f"The {subject} needs a spatial model; in the plane use point_on_line.")
    different(body_1, body_2, subject)
    p1, p2 = point_pair(point, 3, subject)
    body_1, body_2 = body_1.at(p1, subject), body_2.at(p2, subject)
    equations = shared_axis(model, name, body_1, body_2, axis, subject)
    axes = point_pair(axis, 3, subject, "axis")
    a1, a2 = axes
    line, normals = on_line(model, name, (body_1, p1), (body_2, p2), a2, subject)
    turning = lambda: axis_conditions(body_1, p1, a1, body_2, p2, a2)  # noqa: E731
    joint = Joint(name, "cylindrical", equations + line, normals=normals, turning=turning)
    joint.ends = sliding_ends((body_1, p1), (body_2, p2), a2, subject)
    joint.drawing = Drawing(
        (body_1, body_2),
        (p1, p2),
        axes,
        ("axis", "line"),
        lambda p, u, _: cylindrical(model, name, body_1, body_2, point=p, axis=u or axes),
    )
    return joint
