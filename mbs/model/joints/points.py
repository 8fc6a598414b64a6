"""Joints that share a point: spherical, revolute and universal."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from mbs.common.affine import Affine, AffineVector
from mbs.common.checks import direction
from mbs.common.errors import ModelError
from mbs.model.bodies import BodyVocabulary
from mbs.model.body import Body
from mbs.model.ends import PointPair, different
from mbs.model.equation import Equation, dot_products
from mbs.model.joints.joint import Drawing, Joint, JointEnds, JointPlaces, equal_vectors, point_pair
from mbs.model.perpendicular import perpendicular
from mbs.model.turning import Turning

_BIG = 1.0 - 1e-12


def shared_point(
    model: BodyVocabulary, name: str, body_1: Body, body_2: Body, point: PointPair, what: str
) -> list[Equation]:
    """The point of body 1 is the point of body 2."""
    p1, p2 = point_pair(point, model.dimension, what)
    return equal_vectors(name, "point", model.anchor(body_1, p1, what), model.anchor(body_2, p2, what))


def shared_axis(
    model: BodyVocabulary, name: str, body_1: Body, body_2: Body, axis: PointPair, what: str
) -> list[Equation]:
    """The unit vector of body 1 is the unit vector of body 2; of nodes that bend, their directions are the same."""
    a1, a2 = point_pair(axis, model.dimension, what, "axis")
    if may_share(body_1, body_2):
        return equal_vectors(name, "axis", model.anchor_axis(body_1, a1, what), model.anchor_axis(body_2, a2, what))
    if body_2.bends and not body_1.bends:
        body_1, body_2, a1, a2 = body_2, body_1, a2, a1
    along = model.anchor_axis(body_1, a1, what)
    across = perpendicular(direction(a2, 3, f"the axis of {what} on body '{body_2.name}'"))
    return [Equation(name, "axis", dot_products(along, model.anchor_axis(body_2, e, what))) for e in across]


def points_of(body_1: Body, p1: ArrayLike, body_2: Body, p2: ArrayLike) -> tuple[AffineVector, AffineVector]:
    """Where a joint is, on either body."""
    return body_1.point(p1), body_2.point(p2)


def turning_about(body_1: Body, p1: ArrayLike, a1: ArrayLike, body_2: Body, p2: ArrayLike, a2: ArrayLike) -> Turning:
    """The axis of body 1 stays square to two vectors of body 2 that are square to its own axis."""
    u = body_1.vector(direction(a1, 3, "an axis"))
    across = perpendicular(direction(a2, 3, "an axis"))
    return Turning(points_of(body_1, p1, body_2, p2), [(u, body_2.vector(e), 0.0) for e in across])


def may_share(body_1: Body, body_2: Body) -> bool:
    """Whether vectors of one body may become those of the other: not where a node bends or a flexible frame meets the
    ground or another one, because their unit length, which stays a condition of its own, would be stated twice.
    """
    if not (body_1.is_flexible or body_2.is_flexible):
        return True
    rigid = body_2 if body_1.is_flexible else body_1
    return not (body_1.bends or body_2.bends or rigid.is_ground or rigid.is_flexible)


def spherical(model: BodyVocabulary, name: str, body_1: Body, body_2: Body, point: PointPair) -> Joint:
    """Shared point (spatial: ball joint)."""
    what = f"spherical joint '{name}'"
    different(body_1, body_2, what)
    p1, p2 = point_pair(point, model.dimension, what)
    body_1, body_2 = body_1.at(p1, what), body_2.at(p2, what)
    equations = shared_point(model, name, body_1, body_2, point, what)
    joint = Joint(name, "spherical", equations, rows_weight=1.0, places=JointPlaces((body_1, body_2), (p1, p2)))
    joint.ends = JointEnds((body_1, body_2), (body_1.point(p1), body_2.point(p2)))
    joint.drawing = Drawing(
        (body_1, body_2), (p1, p2), None, ("point",), lambda p, u, _: spherical(model, name, body_1, body_2, p)
    )
    return joint


def revolute(
    model: BodyVocabulary, name: str, body_1: Body, body_2: Body, point: PointPair, axis: PointPair | None
) -> Joint:
    """Shared point and, in space, shared axis: all equations are linear."""
    what = f"revolute joint '{name}'"
    different(body_1, body_2, what)
    p1, p2 = point_pair(point, model.dimension, what)
    body_1, body_2 = body_1.at(p1, what), body_2.at(p2, what)
    equations = shared_point(model, name, body_1, body_2, point, what)
    if model.dimension == 3:
        if axis is None:
            raise ModelError(f"The {what} needs an axis in a spatial model.")
        equations += shared_axis(model, name, body_1, body_2, axis, what)
    elif axis is not None:
        raise ModelError(f"The {what} has an axis; in a planar model leave it out.")
    axes = None if axis is None else point_pair(axis, 3, what, "axis")
    places = JointPlaces((body_1, body_2), (p1, p2), axes)
    turning = None
    if axes is not None:
        a1, a2 = axes
        turning = lambda: turning_about(body_1, p1, a1, body_2, p2, a2)  # noqa: E731
    joint = Joint(name, "revolute", equations, rows_weight=1.0, places=places, turning=turning)
    shared = None if axes is None else body_1.vector(direction(axes[0], 3, f"the axis of {what}"))
    joint.ends = JointEnds((body_1, body_2), (body_1.point(p1), body_2.point(p2)), shared)
    conditions = ("point",) if axes is None else ("point", "axis")
    joint.drawing = Drawing(
        (body_1, body_2), (p1, p2), axes, conditions, lambda p, u, _: revolute(model, name, body_1, body_2, p, u)
    )
    return joint


def universal(
    model: BodyVocabulary, name: str, body_1: Body, body_2: Body, point: PointPair, axis_1: ArrayLike, axis_2: ArrayLike
) -> Joint:
    """Shared point, and the angle between an axis of each body stays what it is (one quadratic row)."""
    what = f"universal joint '{name}'"
    if model.dimension == 2:
        raise ModelError(f"The {what} needs a spatial model; this one has dimension 2.")
    different(body_1, body_2, what)
    p1, p2 = point_pair(point, model.dimension, what)
    body_1, body_2 = body_1.at(p1, what), body_2.at(p2, what)
    u1, u2 = direction(axis_1, 3, f"axis_1 of {what}"), direction(axis_2, 3, f"axis_2 of {what}")
    cosine = float(np.dot(u1, u2))
    if abs(cosine) > _BIG:
        raise ModelError(f"The axes of {what} are parallel; a universal joint needs two different directions.")
    a1, a2 = model.anchor_axis(body_1, u1, what), model.anchor_axis(body_2, u2, what)
    equations = shared_point(model, name, body_1, body_2, point, what)
    equations.append(Equation(name, "axes", dot_products(a1, a2), Affine({}, -cosine)))
    turning = lambda: Turning(points_of(body_1, p1, body_2, p2), [(a1, a2, cosine)])  # noqa: E731
    joint = Joint(name, "universal", equations, rows_weight=1.0, turning=turning)
    joint.ends = JointEnds((body_1, body_2), (body_1.point(p1), body_2.point(p2)))
    joint.drawing = Drawing(
        (body_1, body_2),
        (p1, p2),
        (u1, u2),
        ("point", "angle"),
        lambda p, u, _: universal(model, name, body_1, body_2, p, *(u or (u1, u2))),
    )
    return joint
