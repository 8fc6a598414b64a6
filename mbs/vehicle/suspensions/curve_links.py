"""Arms and rods of an axle given by curves: bodies that rotate so that their outer ends follow points of the carrier.

With half of the mass m of a uniform rod in the carrier the weight would be right, but the kinetic energy would be that
of m/2 at the end of the rod instead of m/3.
"""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from mbs.model.coordinate import Coordinate
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.part import Part
from mbs.vehicle.quantities import Point
from mbs.vehicle.section import Section
from mbs.vehicle.side import Side
from mbs.vehicle.suspensions.curve_poses import WheelCurves

Array = NDArray[np.float64]

MIN_LENGTH = 0.05  # m


class LinkPoints(Section):
    """Ends of a link, on the left side."""

    inner: Point
    """On the chassis."""
    second_inner: Point | None = None
    """The other one on the chassis of an arm, which turns about the axis through both."""
    outer: Point
    """On the carrier."""

    def foot(self) -> Array:
        """Point about which the link rotates, m: its inner end, or the point of its axis nearest to its outer end."""
        inner = np.array(self.inner)
        axis = np.subtract(self.second_inner or self.inner, inner)
        return np.asarray(inner + axis * (axis @ (np.array(self.outer) - inner)) / max(axis @ axis, MIN_LENGTH**2))

    def faults(self) -> Iterator[str]:
        """Yield a fault of a link that is too short."""
        length = float(np.linalg.norm(np.array(self.outer) - self.foot()))
        if length < MIN_LENGTH:
            reference = "the axis of both inner ends" if self.second_inner else self.key("inner")
            yield f"{self.key('outer')} is {length:.3g} m from {reference}; it must be {MIN_LENGTH:g} m or more."


class CurveLink(Part):
    """Arm or rod between chassis and carrier; one without a second inner end does not turn about its own line."""

    points: LinkPoints
    """Ends."""

    def build(
        self, b: CarBuilder, side: Side, name: str, centre: Array, curves: WheelCurves, over: Sequence[Coordinate]
    ) -> None:
        """Add the link as a lookup-table body on the chassis.

        Parameters
        ----------
        name : str
            Name of the link.
        centre : ndarray, shape (3,)
            Wheel centre as drawn, m.
        curves : WheelCurves
            Curves of the wheel without compliance.
        over : sequence of Coordinate
            Coordinates of the variables of the curves.
        """
        left_points = self.points.foot().tolist(), self.points.outer, self.com
        foot, outer, com = np.array([side.point(point) for point in left_points])
        arms = curves.centres + curves.rotations @ (outer - centre) - foot
        arms = arms if len(over) == 2 else arms[:, 0]
        lengths = np.linalg.norm(outer - foot) * np.linalg.norm(arms, axis=-1)
        shortest = np.concatenate([np.cross(outer - foot, arms), (lengths + arms @ (outer - foot))[..., None]], axis=-1)
        rotations = Rotation.from_quat(shortest.reshape(-1, 4)).as_matrix().reshape(*arms.shape, 3)
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
