"""A lever on a carrier and a rod from its end to another body, both without mass: one angle and one row."""

import numpy as np
from numpy.typing import ArrayLike

from mbs.common.affine import Affine
from mbs.common.checks import direction, vector
from mbs.common.errors import ModelError
from mbs.model.bodies import BodyVocabulary
from mbs.model.body import Body
from mbs.model.coordinate import Coordinate
from mbs.model.equation import AnglePart, Equation, dot_products
from mbs.model.joint_ends import different
from mbs.model.joints.joint import Joint

DEAD_POINT = 0.1
"""Least sine of the angle between lever and rod as drawn, and least part of the lever perpendicular to its axis."""


def drop_link(
    model: BodyVocabulary,
    name: str,
    carrier: Body,
    body: Body,
    *,
    pivot: ArrayLike,
    axis: ArrayLike,
    lever_end: ArrayLike,
    link_end: ArrayLike,
) -> Coordinate:
    """A lever that turns on a carrier and a rod from its end to a point of another body, both without mass.

    Two of them and `anti_roll_bar` are an anti-roll bar with its links. Against two bodies with joints it costs one
    coordinate and one equation. The tension of the rod is a joint force.

    The equation is ``(|g|^2 + r^2 - L^2)/2 - g . (cos(theta) u + sin(theta) w) = 0`` with theta = 0 as drawn. The lever
    u of length r is square to its axis a, ``w = a x u``; both are vectors of the carrier. The vector g goes from the
    axis to the end of the rod on the body.

    Parameters
    ----------
    carrier, body : Body
        Body on which the lever turns, and body at the end of the rod; in space, not point masses.
    pivot, axis : array_like, shape (3,)
        A point of the lever's axis, m, and its direction, fixed in the carrier; earth axes as drawn.
    lever_end, link_end : array_like, shape (3,)
        Ends of the rod on the lever and on the body, earth axes as drawn, m.

    Returns
    -------
    Coordinate
        Angle of the lever about the axis, rad, 0 as drawn and not wrapped.

    Raises
    ------
    ModelError
        The bodies are the same, the lever lies along its axis, or the rod pulls along the lever or across its plane
        and could not turn it.
    """
    subject = f"drop link '{name}'"
    different(carrier, body, subject)
    for link_body in (carrier, body):
        if model.owned(link_body, f"The {subject}").is_point:
            raise ModelError(f"The {subject} needs bodies with axes; '{link_body.name}' is a point mass.")
    if model.dimension != 3:
        raise ModelError(f"The {subject} needs a spatial model; this one has dimension 2.")
    a = direction(axis, 3, f"the axis of {subject}")
    c, e, p = (
        vector(point, 3, f"the {label} of {subject}")
        for point, label in ((pivot, "pivot"), (lever_end, "end of the lever"), (link_end, "end of the rod"))
    )
    along = float(np.dot(e - c, a))
    u = e - c - along * a
    lever, rod = float(np.linalg.norm(u)), float(np.linalg.norm(p - e))
    if lever <= DEAD_POINT * float(np.linalg.norm(e - c)) or rod <= 0.0:
        raise ModelError(f"The lever of {subject} lies along its axis, or its rod has no length; nothing could turn.")
    w = np.cross(a, u)
    if abs(float(np.dot(p - e, w))) < DEAD_POINT * lever * rod:
        raise ModelError(f"The {subject} is drawn at a dead point: its rod goes along the lever or across its plane.")
    # from the foot of the perpendicular from the end of the lever to its axis
    centre = c + along * a
    gap = model.anchor(body, p, subject) - model.anchor(carrier, centre, subject)
    model.anchor_axis(carrier, a, subject)
    theta = model.new_coordinate(name, "angle", 0.0)
    row = Equation(
        name,
        "distance",
        dot_products(gap, gap, 0.5),
        Affine({}, 0.5 * (lever * lever - rod * rod)),
        angle=AnglePart(theta, dot_products(gap, carrier.vector(w)), dot_products(gap, carrier.vector(-u))),
    )
    model._join(Joint(name, "drop_link", [row], rows_weight=rod))
    return Coordinate(name, theta, "rad")
