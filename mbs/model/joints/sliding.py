"""Joints that slide along a line: point on line, cylindrical and prismatic; and the weld."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from mbs.common.affine import AffineVector
from mbs.common.checks import direction
from mbs.common.errors import ModelError
from mbs.model.bodies import BodyVocabulary
from mbs.model.body import Body
from mbs.model.ends import PointPair, body_and_point, different
from mbs.model.equation import Equation, dot_products
from mbs.model.joints.joint import Drawing, Joint, JointEnds, JointPlaces, equal_vectors, point_pair
from mbs.model.joints.points import may_share, points_of, shared_axis, shared_point, turning_about
from mbs.model.perpendicular import perpendicular
from mbs.model.turning import Turning


def _normals(model: BodyVocabulary, body: Body, axis: ArrayLike, what: str) -> list[AffineVector]:
    """Vectors of `body` that are perpendicular to the axis: one in the plane, two in space."""
    if model.dimension == 2:
        u = direction(axis, 2, f"the axis of {what}")
        return [model.anchor_axis(body, np.array([-u[1], u[0]]), what)]
    return [model.anchor_axis(body, e, what) for e in perpendicular(direction(axis, 3, f"the axis of {what}"))]


def on_line(
    model: BodyVocabulary,
    name: str,
    end_1: tuple[Body, ArrayLike],
    end_2: tuple[Body, ArrayLike],
    axis: ArrayLike,
    what: str,
) -> tuple[list[Equation], list[AffineVector]]:
    """The point of body 1 stays on the line through the point of body 2 along an axis fixed in body 2; also the
    normals of the line.
    """
    body_2 = model.owned(end_2[0], f"The {what}")
    if body_2.is_point:
        raise ModelError(f"The line of {what} needs a body with axes; '{body_2.name}' is a point mass.")
    gap = model.anchor(end_1[0], end_1[1], what) - model.anchor(body_2, end_2[1], what)
    normals = _normals(model, body_2, axis, what)
    return [Equation(name, "line", dot_products(gap, n)) for n in normals], normals


def _sliding_ends(
    end_1: tuple[Body, ArrayLike], end_2: tuple[Body, ArrayLike], axis: ArrayLike, what: str
) -> JointEnds:
    """The point of body 1 slides along the axis of body 2."""
    (body_1, p1), (body_2, p2) = end_1, end_2
    # a vector of a node that bends would bring rows of its own
    turning = body_2.owner if body_2.bends else body_2
    along = turning.vector(direction(axis, body_2.dimension, f"the axis of {what}"))
    return JointEnds((body_1, body_2), (body_1.point(p1), body_2.point(p2)), along, slides=True)


def same_orientation(model: BodyVocabulary, name: str, body_1: Body, body_2: Body, what: str) -> list[Equation]:
    """Body 1 does not turn against body 2: all axes are shared (linear); of nodes that bend, their directions."""
    axes = np.eye(model.dimension)[: 1 if model.dimension == 2 else 3]
    for body in (body_1, body_2):
        if model.owned(body, f"The {what}").is_point:
            raise ModelError(f"The {what} needs bodies with axes; '{body.name}' is a point mass.")
    if may_share(body_1, body_2):
        return [e for u in axes for e in equal_vectors(name, "axis", body_1.vector(u), body_2.vector(u))]
    if body_2.bends and not body_1.bends:
        body_1, body_2 = body_2, body_1
    first = [model.anchor_axis(body_1, u, what) for u in axes[:2]]
    second = [model.anchor_axis(body_2, u, what) for u in axes[1:]]
    pairs = ((first[0], second[0]), (first[0], second[1]), (first[1], second[1]))
    return [Equation(name, "axis", dot_products(u, v)) for u, v in pairs]


def no_turning(body_1: Body, p1: ArrayLike, body_2: Body, p2: ArrayLike) -> Turning:
    """Axes of body 1 stay square to other axes of body 2."""
    axes = np.eye(len(body_1.com))
    pairs = [(0, 1)] if len(axes) == 2 else [(0, 1), (0, 2), (1, 2)]
    vectors = [(body_1.vector(axes[i]), body_2.vector(axes[j]), 0.0) for i, j in pairs]
    return Turning(points_of(body_1, p1, body_2, p2), vectors)


def point_on_line(
    model: BodyVocabulary, name: str, end_1: tuple[Body, ArrayLike], end_2: tuple[Body, ArrayLike], axis: ArrayLike
) -> Joint:
    """Point of body 1 on a line fixed in body 2."""
    what = f"point-on-line joint '{name}'"
    end_1, end_2 = (body_and_point(end, what, "(body, point)") for end in (end_1, end_2))
    different(end_1[0], end_2[0], what)
    line, normals = on_line(model, name, end_1, end_2, axis, what)
    joint = Joint(name, "point_on_line", line, normals=normals)
    joint.ends = _sliding_ends(end_1, end_2, axis, what)
    joint.drawing = Drawing(
        (end_1[0], end_2[0]),
        (end_1[1], end_2[1]),
        (axis, axis),
        ("line",),
        lambda p, u, _: point_on_line(model, name, (end_1[0], p[0]), (end_2[0], p[1]), (u or (axis, axis))[1]),
    )
    return joint


def cylindrical(
    model: BodyVocabulary, name: str, body_1: Body, body_2: Body, point: PointPair, axis: PointPair
) -> Joint:
    """Shared axis direction, and the point of body 1 on the axis of body 2."""
    what = f"cylindrical joint '{name}'"
    if model.dimension == 2:
        raise ModelError(f"The {what} needs a spatial model; in the plane use point_on_line.")
    different(body_1, body_2, what)
    p1, p2 = point_pair(point, 3, what)
    body_1, body_2 = body_1.at(p1, what), body_2.at(p2, what)
    equations = shared_axis(model, name, body_1, body_2, axis, what)
    axes = point_pair(axis, 3, what, "axis")
    a1, a2 = axes
    line, normals = on_line(model, name, (body_1, p1), (body_2, p2), a2, what)
    turning = lambda: turning_about(body_1, p1, a1, body_2, p2, a2)  # noqa: E731
    joint = Joint(name, "cylindrical", equations + line, normals=normals, turning=turning)
    joint.ends = _sliding_ends((body_1, p1), (body_2, p2), a2, what)
    joint.drawing = Drawing(
        (body_1, body_2),
        (p1, p2),
        axes,
        ("axis", "line"),
        lambda p, u, _: cylindrical(model, name, body_1, body_2, p, u or axes),
    )
    return joint


def prismatic(
    model: BodyVocabulary, name: str, body_1: Body, body_2: Body, point: PointPair | None, axis: ArrayLike
) -> Joint:
    """Shared orientation, and the point of body 1 on the axis of body 2; without a point, the centre of mass of a
    moving body.
    """
    what = f"prismatic joint '{name}'"
    different(body_1, body_2, what)
    if point is None:
        point = body_2.com if body_1.is_ground else body_1.com
    p1, p2 = point_pair(point, model.dimension, what)
    equations = same_orientation(model, name, body_1, body_2, what)
    line, normals = on_line(model, name, (body_1, p1), (body_2, p2), axis, what)
    places = JointPlaces((body_1, body_2), (p1, p2), (axis, axis))
    turning = lambda: no_turning(body_1, p1, body_2, p2)  # noqa: E731
    joint = Joint(name, "prismatic", equations + line, normals=normals, places=places, turning=turning)
    joint.ends = _sliding_ends((body_1, p1), (body_2, p2), axis, what)
    joint.drawing = Drawing(
        (body_1, body_2),
        (p1, p2),
        (axis, axis),
        ("orientation", "line"),
        lambda p, u, _: prismatic(model, name, body_1, body_2, p, (u or (axis, axis))[1]),
    )
    return joint


def weld(model: BodyVocabulary, name: str, body_1: Body, body_2: Body) -> Joint:
    """Both bodies move as one; all equations are linear."""
    what = f"weld '{name}'"
    different(body_1, body_2, what)
    point = body_2.com if body_1.is_ground or body_2.is_node else body_1.com
    if body_1.is_point or body_2.is_point:
        point = body_1.com if body_1.is_point else body_2.com
        joint = Joint(name, "weld", shared_point(model, name, body_1, body_2, point, what), rows_weight=1.0)
        joint.ends = JointEnds((body_1, body_2), (body_1.point(point), body_2.point(point)))
        return joint
    equations = shared_point(model, name, body_1, body_2, point, what)
    equations += same_orientation(model, name, body_1, body_2, what)
    places = JointPlaces((body_1, body_2), (point, point))
    turning = lambda: no_turning(body_1, point, body_2, point)  # noqa: E731
    joint = Joint(name, "weld", equations, rows_weight=1.0, places=places, turning=turning)
    joint.ends = JointEnds((body_1, body_2), (body_1.point(point), body_2.point(point)))
    return joint
