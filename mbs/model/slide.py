"""A point that a guide slides along a direction fixed in a body (the rack of a car)."""

from __future__ import annotations

from dataclasses import dataclass

from mbs.affine import AffineVector
from mbs.model.body import Body


@dataclass(frozen=True)
class SlidingPoint:
    """``p(s) = start + s * direction`` with the guide s in m; an end of `Model.distance`.

    Attributes
    ----------
    start, direction : AffineVector
        Point and unit vector of the body.
    guide : int
        Number of the guide.
    """

    name: str
    body: Body
    start: AffineVector
    direction: AffineVector
    guide: int
