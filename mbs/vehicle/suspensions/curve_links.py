"""Arms and rods of an axle by its curves: the carrier that the table places moves their outer ends.

An arm of mass m turns about the chassis, and half of it on the carrier, half on the chassis weighs what it weighs, but
has more kinetic energy over the travel of the wheel: m/2 for the m/3 of a uniform rod. Here it is a body that turns
about its inner end as its outer end asks for, so weight, inertia and what both do to the chassis are its own.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from mbs.model.coordinate import Coordinate
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.part import Part
from mbs.vehicle.quantities import Point
from mbs.vehicle.section import Section
from mbs.vehicle.side import Side
from mbs.vehicle.suspensions.curve_poses import WheelCurves

Array = NDArray[np.float64]

SHORTEST = 0.05  # m


class LinkPoints(Section):
    """Ends of a link, on the left side."""

    inner: Point
    """On the chassis."""
    second_inner: Point | None = None
    """The other one on the chassis of an arm, which turns about the axis through both."""
    outer: Point
    """On the carrier."""

    def foot(self) -> Array:
        """Where the link turns: its inner end, or the point of the axis next to its outer end, m."""
        inner = np.array(self.inner)
        if self.second_inner is None:
            return inner
        along = np.subtract(self.second_inner, self.inner)
        return np.asarray(inner + along * (along @ (np.array(self.outer) - inner)) / max(along @ along, SHORTEST**2))

    def faults(self) -> Iterator[str]:
        """The link has a length."""
        length = float(np.linalg.norm(np.array(self.outer) - self.foot()))
        if length < SHORTEST:
            what = "the axis of both inner ends" if self.second_inner else self.key("inner")
            yield f"{self.key('outer')} is {length:.3g} m from {what}; it must be {SHORTEST:g} m or more."
        between = np.inf if self.second_inner is None else math.dist(self.second_inner, self.inner)
        if between < SHORTEST:
            yield (
                f"{self.key('second_inner')} is {between:.3g} m from {self.key('inner')}; it must be {SHORTEST:g} m or "
                "more, or be left out."
            )


class CurveLink(Part):
    """Arm or rod between chassis and carrier; one without a second inner end does not turn about its own line."""

    points: LinkPoints
    """Ends."""

    def build(
        self, b: CarBuilder, side: Side, name: str, centre: Array, curves: WheelCurves, over: Sequence[Coordinate]
    ) -> None:
        """Add the body on the chassis.

        Parameters
        ----------
        name : str
            Of the link.
        centre : ndarray, shape (3,)
            Of the wheel as drawn, m.
        curves : WheelCurves
            Of the wheel that it carries, without compliance: what gives are bushes of small mass.
        over : sequence of Coordinate
            What they are functions of.
        """
        foot, outer, com = (np.array(side.point(p)) for p in (self.points.foot(), self.points.outer, self.com))
        to = curves.centres + curves.rotations @ (outer - centre) - foot
        rotations = shortest_turns(outer - foot, to if len(over) == 2 else to[:, 0])
        b.m.tabled_body(
            f"{name} {side.wheel}",
            base=b.chassis.frame,
            parameters=over,
            axes=[curves.travel, curves.second][: len(over)],
            places=foot + rotations @ (com - foot),
            rotations=rotations,
            mass=self.mass,
            com=com,
            inertia=self.inertia,
        )


def shortest_turns(drawn: Array, now: Array) -> Array:
    """Rotations about axes at right angles to both that turn a direction into others.

    Parameters
    ----------
    drawn : ndarray, shape (3,)
        From.
    now : ndarray, shape (..., 3)
        To.

    Returns
    -------
    ndarray, shape (..., 3, 3)
        I + [v] + [v]^2/(1 + c), with v the cross product and c the dot product of the unit vectors (Rodrigues).
    """
    a, to = drawn / np.linalg.norm(drawn), now / np.linalg.norm(now, axis=-1, keepdims=True)
    v, c = np.cross(a, to), to @ a
    skew = np.cross(v[..., None, :], np.eye(3)).swapaxes(-1, -2)
    return np.asarray(np.eye(3) + skew + skew @ skew / (1.0 + c)[..., None, None])
