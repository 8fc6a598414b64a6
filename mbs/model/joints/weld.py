"""The weld."""

from mbs.model.bodies import BodyVocabulary
from mbs.model.body import Body
from mbs.model.joint_ends import different
from mbs.model.joints.joint import Joint, JointEnds, JointPlaces
from mbs.model.joints.points import shared_point
from mbs.model.joints.prismatic import orientation_conditions, same_orientation


def weld(model: BodyVocabulary, name: str, body_1: Body, body_2: Body) -> Joint:
    """Weld: the bodies move as one.

    Parameters
    ----------
    body_1, body_2 : Body
        Bodies, point masses, the ground, or nodes of flexible bodies.
    """
    subject = f"weld '{name}'"
    different(body_1, body_2, subject)
    point = body_2.com if body_1.is_ground or body_2.is_node else body_1.com
    if body_1.is_point or body_2.is_point:
        point = body_1.com if body_1.is_point else body_2.com
        joint = Joint(name, "weld", shared_point(model, name, body_1, body_2, point, subject), rows_weight=1.0)
        joint.ends = JointEnds((body_1, body_2), (body_1.point(point), body_2.point(point)))
        return joint
    equations = shared_point(model, name, body_1, body_2, point, subject)
    equations += same_orientation(model, name, body_1, body_2, subject)
    places = JointPlaces((body_1, body_2), (point, point))
    turning = lambda: orientation_conditions(body_1, point, body_2, point)  # noqa: E731
    joint = Joint(name, "weld", equations, rows_weight=1.0, places=places, turning=turning)
    joint.ends = JointEnds((body_1, body_2), (body_1.point(point), body_2.point(point)))
    return joint
