"""The revolute joint."""

from __future__ import annotations

from mbs.common.checks import direction
from mbs.common.errors import ModelError
from mbs.model.bodies import BodyVocabulary
from mbs.model.body import Body
from mbs.model.joint_ends import PointPair, different
from mbs.model.joints.joint import Drawing, Joint, JointEnds, JointPlaces, point_pair
from mbs.model.joints.points import axis_conditions, shared_axis, shared_point


def revolute(
    model: BodyVocabulary, name: str, body_1: Body, body_2: Body, *, point: PointPair, axis: PointPair | None = None
) -> Joint:
    """Revolute joint: the bodies share a point and, in space, an axis.

    Parameters
    ----------
    body_1, body_2 : Body
        Bodies, the ground, or nodes of flexible bodies.
    point : array_like, shape (dimension,), or pair of them
        Earth axes in the reference configuration, m; a pair is one point per body.
    axis : array_like, shape (3,), or pair of them, optional
        Of any length; in space only.

    Raises
    ------
    ModelError
        The bodies are the same, or the axis is missing in space or given in the plane.
    """
    subject = f"revolute joint '{name}'"
    different(body_1, body_2, subject)
    p1, p2 = point_pair(point, model.dimension, subject)
    body_1, body_2 = body_1.at(p1, subject), body_2.at(p2, subject)
    equations = shared_point(model, name, body_1, body_2, point, subject)
    if model.dimension == 3:
        if axis is None:
            raise ModelError(f"The {subject} needs an axis in a spatial model.")
        equations += shared_axis(model, name, body_1, body_2, axis, subject)
    elif axis is not None:
        raise ModelError(f"The {subject} has an axis; in a planar model leave it out.")
    axes = None if axis is None else point_pair(axis, 3, subject, "axis")
    places = JointPlaces((body_1, body_2), (p1, p2), axes)
    turning = None
    if axes is not None:
        a1, a2 = axes
        turning = lambda: axis_conditions(body_1, p1, a1, body_2, p2, a2)  # noqa: E731
    joint = Joint(name, "revolute", equations, rows_weight=1.0, places=places, turning=turning)
    axis_vector = None if axes is None else body_1.vector(direction(axes[0], 3, f"the axis of {subject}"))
    joint.ends = JointEnds((body_1, body_2), (body_1.point(p1), body_2.point(p2)), axis_vector)
    conditions = ("point",) if axes is None else ("point", "axis")
    joint.drawing = Drawing(
        (body_1, body_2),
        (p1, p2),
        axes,
        conditions,
        lambda p, u, _: revolute(model, name, body_1, body_2, point=p, axis=u),
    )
    return joint
