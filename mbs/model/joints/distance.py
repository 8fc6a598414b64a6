"""Constant or driven distance between two points: a massless rod is one row."""

import numpy as np
from numpy.typing import ArrayLike

from mbs.common.affine import Affine, AffineVector
from mbs.common.checks import positive
from mbs.common.errors import ModelError
from mbs.model.bodies import BodyVocabulary
from mbs.model.body import Body
from mbs.model.carried_parts import SlidingPoint
from mbs.model.equation import DrivingTerm, Equation, dot_products
from mbs.model.joint_ends import End, body_and_point, different
from mbs.model.joints.joint import Drawing, Joint, JointEnds

ENDS = "(body, point), a point mass or a sliding point"


def end_point(model: BodyVocabulary, end: End, subject: str) -> tuple[AffineVector, SlidingPoint | None]:
    """The point of an end, at driving function value zero if it slides, and the sliding point."""
    if isinstance(end, SlidingPoint):
        model.owned(end.body, subject)
        return end.start, end
    body, point = body_and_point(end, subject, ENDS)
    return model.anchor(body, point, subject), None


def end_body(end: End, subject: str) -> Body:
    """The body at an end of a rod, also if its point slides."""
    return end.body if isinstance(end, SlidingPoint) else body_and_point(end, subject, ENDS)[0]


def distance(model: BodyVocabulary, name: str, end_1: End, end_2: End, *, length: float | None = None) -> Joint:
    """Massless rod: the distance of two points is constant.

    The equation is ``(|p_1 - p_2|^2 - length^2)/2 = 0``; its multiplier times the length is the tension.

    Parameters
    ----------
    end_1, end_2 : (Body, array_like), Body or SlidingPoint
        A body and its point, m; a body alone for its centre of mass; or a point that a driving function slides (one of
        the two at most).
    length : float, optional
        m; by default as drawn.

    Returns
    -------
    Joint
        For sensors: its force is the tension.

    Raises
    ------
    ModelError
        Both ends are on the same body, or the length is not positive.
    """
    subject = f"distance '{name}'"
    bodies = end_body(end_1, subject), end_body(end_2, subject)
    p1, slide_1 = end_point(model, end_1, subject)
    p2, slide_2 = end_point(model, end_2, subject)
    if slide_1 is not None and slide_2 is not None:
        raise ModelError(f"Both ends of {subject} slide; only one end may be a sliding point.")
    gap = p1 - p2
    if not any(c.terms for c in gap.components):
        raise ModelError(f"The {subject} joins two points of the ground; one end must be able to move.")
    if slide_1 is None and slide_2 is None and bodies[0].flexibility is None:  # which has many nodes
        different(*bodies, subject)
    drawn_length = float(np.linalg.norm(gap.value(model.drawn())))
    if length is None:
        if drawn_length <= 0.0:
            raise ModelError(f"The {subject} has zero length; use a spherical joint for points that coincide.")
        length = drawn_length
    length = positive(length, f"The length of {subject}")
    constant = Affine({}, -0.5 * length * length)
    slide, sign = (slide_1, 1.0) if slide_1 is not None else (slide_2, -1.0)
    guides: list[DrivingTerm] = []
    if slide is not None:
        for direction, guide in slide.ways:
            guides += [
                DrivingTerm(guide, 1, dot_products(gap, direction, sign)),
                DrivingTerm(guide, 2, linear=Affine({}, 0.5)),
            ]
    joint = Joint(
        name,
        "distance",
        [Equation(name, "distance", dot_products(gap, gap, 0.5), constant, guides)],
        rows_weight=length,
    )
    joint.ends = JointEnds(bodies, (p1, p2), rod=True)
    joint.slide = None if slide is None else (0 if slide_1 is not None else 1, slide)
    if slide is None:
        joint.drawing = _drawing(model, name, end_1, end_2, length)
    return joint


def _drawing(model: BodyVocabulary, name: str, end_1: End, end_2: End, length: float) -> Drawing:
    """Drawing of a rod with fixed ends."""
    first, second = (body_and_point(end, name) for end in (end_1, end_2))
    return Drawing(
        (first[0], second[0]),
        (_drawn_end_point(*first), _drawn_end_point(*second)),
        None,
        ("distance",),
        lambda p, _, rod: distance(model, name, (first[0], p[0]), (second[0], p[1]), length=rod),
        length,
    )


def _drawn_end_point(body: Body, point: ArrayLike | None) -> ArrayLike:
    """The point of an end; None: the centre of mass."""
    return body.com if point is None else point
