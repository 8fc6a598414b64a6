"""Screw joint: a cylindrical joint whose slide and turn are coupled by a pitch."""

import math

from numpy.typing import ArrayLike

from mbs.common.checks import not_zero
from mbs.common.errors import ModelError
from mbs.model.angle import angle_and_joint
from mbs.model.bodies import BodyVocabulary
from mbs.model.body import Body
from mbs.model.coordinate import Coordinate
from mbs.model.equation import Equation, dot_products
from mbs.model.joints.joint import Joint
from mbs.model.joints.sliding import cylindrical
from mbs.model.joints.transmission import rotation_from_drawn


class Screw(Joint):
    """A screw joint; `angle` is the relative angle of its first body against its second."""

    angle: Coordinate


def screw(
    model: BodyVocabulary, name: str, body_1: Body, body_2: Body, *, point: ArrayLike, axis: ArrayLike, pitch: float
) -> Screw:
    """Screw joint: a shared axis along which body 1 moves in proportion to its turn against body 2.

    To the equations of a cylindrical joint it adds ``(p_1 - p_2) . e = pitch / (2 pi) * theta``.

    Parameters
    ----------
    body_1, body_2 : Body
        Bodies or the ground of a spatial model.
    point : array_like, shape (3,)
        On the axis, m.
    axis : array_like, shape (3,)
        Of any length.
    pitch : float
        Way along the axis per turn, m; positive for a right-hand thread.

    Returns
    -------
    Screw
        Its `angle` is that turn, rad, a coordinate for sensors and torques.

    Raises
    ------
    ModelError
        The model is planar, the pitch is zero, or the bodies are the same.
    """
    subject = f"screw joint '{name}'"
    if model.dimension == 2:
        raise ModelError(f"The {subject} needs a spatial model; this one has dimension 2.")
    lead = not_zero(pitch, f"The pitch of {subject}")
    shaft = cylindrical(model, name, body_1, body_2, point=point, axis=axis)
    angle, angle_joint = angle_and_joint(model, f"{name}.angle", body_2, body_1, axis, 0.0)
    gap = model.anchor(body_1, point, subject) - model.anchor(body_2, point, subject)
    thread = dot_products(gap, model.anchor_axis(body_2, axis, subject))
    row = Equation(name, "thread", thread, rotation_from_drawn(model, angle) * (-lead / (2.0 * math.pi)))
    joint = Screw(name, "screw", [row, *shaft.equations], rows_weight=1.0)
    joint.angle, joint.as_rows = angle, True  # angles are never eliminated
    model._join(joint)
    model._join(angle_joint)
    return joint
