"""Equations of joints with a shared point or axis, and the spherical joint."""

from numpy.typing import ArrayLike

from mbs.common.affine import AffineVector
from mbs.common.checks import direction
from mbs.model.bodies import BodyVocabulary
from mbs.model.body import Body
from mbs.model.equation import Equation, dot_products
from mbs.model.joint_ends import PointPair, different
from mbs.model.joint_rotation import RotationConditions
from mbs.model.joints.joint import Drawing, Joint, JointEnds, JointPlaces, equal_vectors, point_pair
from mbs.model.perpendicular_vectors import perpendicular


def shared_point(
    model: BodyVocabulary, name: str, body_1: Body, body_2: Body, point: PointPair, subject: str
) -> list[Equation]:
    """Equations of a point that both bodies share."""
    p1, p2 = point_pair(point, model.dimension, subject)
    return equal_vectors(name, "point", model.anchor(body_1, p1, subject), model.anchor(body_2, p2, subject))


def shared_axis(
    model: BodyVocabulary, name: str, body_1: Body, body_2: Body, axis: PointPair, subject: str
) -> list[Equation]:
    """Equations of a unit vector that both bodies share, or of its direction if a node bends."""
    a1, a2 = point_pair(axis, model.dimension, subject, "axis")
    if can_share_vectors(body_1, body_2):
        return equal_vectors(
            name, "axis", model.anchor_axis(body_1, a1, subject), model.anchor_axis(body_2, a2, subject)
        )
    if body_2.bends and not body_1.bends:
        body_1, body_2, a1, a2 = body_2, body_1, a2, a1
    along = model.anchor_axis(body_1, a1, subject)
    normals = perpendicular(direction(a2, 3, f"the axis of {subject} on body '{body_2.name}'"))
    return [Equation(name, "axis", dot_products(along, model.anchor_axis(body_2, e, subject))) for e in normals]


def joint_points(body_1: Body, p1: ArrayLike, body_2: Body, p2: ArrayLike) -> tuple[AffineVector, AffineVector]:
    """Points of the joint on both bodies."""
    return body_1.point(p1), body_2.point(p2)


def axis_conditions(
    body_1: Body, p1: ArrayLike, a1: ArrayLike, body_2: Body, p2: ArrayLike, a2: ArrayLike
) -> RotationConditions:
    """Conditions that keep the axis of body 1 perpendicular to two normals of the axis of body 2."""
    u = body_1.vector(direction(a1, 3, "an axis"))
    normals = perpendicular(direction(a2, 3, "an axis"))
    return RotationConditions(joint_points(body_1, p1, body_2, p2), [(u, body_2.vector(e), 0.0) for e in normals])


def can_share_vectors(body_1: Body, body_2: Body) -> bool:
    """Whether linear equations may make vectors of two bodies equal.

    Not if a node bends, or a flexible frame meets the ground or another frame: their unit length is a separate row,
    which would be repeated.
    """
    if not (body_1.is_flexible or body_2.is_flexible):
        return True
    rigid = body_2 if body_1.is_flexible else body_1
    return not (body_1.bends or body_2.bends or rigid.is_ground or rigid.is_flexible)


def spherical(model: BodyVocabulary, name: str, body_1: Body, body_2: Body, *, point: PointPair) -> Joint:
    """Spherical joint: the bodies share a point.

    Parameters
    ----------
    body_1, body_2 : Body
        Bodies, point masses, the ground, or nodes of flexible bodies.
    point : array_like, shape (dimension,), or pair of them
        Earth axes in the reference configuration, m; a pair is one point per body.
    """
    subject = f"spherical joint '{name}'"
    different(body_1, body_2, subject)
    p1, p2 = point_pair(point, model.dimension, subject)
    body_1, body_2 = body_1.at(p1, subject), body_2.at(p2, subject)
    equations = shared_point(model, name, body_1, body_2, point, subject)
    joint = Joint(name, "spherical", equations, rows_weight=1.0, places=JointPlaces((body_1, body_2), (p1, p2)))
    joint.ends = JointEnds((body_1, body_2), (body_1.point(p1), body_2.point(p2)))
    joint.drawing = Drawing(
        (body_1, body_2), (p1, p2), None, ("point",), lambda p, u, _: spherical(model, name, body_1, body_2, point=p)
    )
    return joint
