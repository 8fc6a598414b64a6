"""Points of the chassis to which other parts are attached, recorded while a car is built on a rigid chassis."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from numpy.typing import ArrayLike

from mbs.common.affine import AffineVector
from mbs.model.body import Body
from mbs.model.joints.joint import Joint
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.side import Point

POINT_TOLERANCE = 1e-9  # m


@dataclass(frozen=True)
class Attachments:
    """Hard points on the chassis of the left side and of the centre plane, m."""

    axles: tuple[tuple[Point, ...], tuple[Point, ...]]
    """Points of the front axle with the steering, then of the rear axle, in the order in which they are built."""
    held: tuple[tuple[Point, Point], ...]
    """Pairs of points, or of a point and an image, at a constant distance, such as the pivots of a wishbone."""


class _RecordingChassis(Body):
    """The chassis, which records the points that are requested."""

    def __init__(self, owner: Body, reference: Point) -> None:
        super().__init__(owner.model, owner.name, owner.com, owner.start)
        self.reference_point = reference
        self.points: dict[Point, None] = {}

    def point(self, position: ArrayLike) -> AffineVector:
        """Record a point and return it as a point of the chassis."""
        x, y, z = (float(v) for v in np.asarray(position))
        if np.linalg.norm(np.subtract((x, y, z), self.reference_point)) > POINT_TOLERANCE:
            self.points[x, y, z] = None
        return super().point(position)


def attachments(b: CarBuilder, parts: Callable[[CarBuilder], Iterable[object]]) -> Attachments:
    """Build the mechanism of a car and record its points on the chassis.

    `b`: builder with a rigid chassis alone; `parts`: adds the parts of the mechanism: steering and front axle, then
    rear axle.
    """
    chassis = _RecordingChassis(b.chassis.body, b.chassis.origin)
    b.chassis = replace(b.chassis, body=chassis)
    counts = []
    for _ in parts(b):
        counts.append(len(chassis.points))
    points = list(chassis.points)
    axle_points = (points[: counts[0]], points[counts[0] : counts[1]])
    axles = tuple(tuple(p for p in part if p[1] >= 0.0) for part in axle_points)
    return Attachments((axles[0], axles[1]), tuple(_joint_pairs(chassis, b.m.joints)))


def _joint_pairs(chassis: Body, joints: list[Joint]) -> Iterator[tuple[Point, Point]]:
    """Yield pairs of points at which one part is joined to the chassis, without the images of other pairs."""
    points_by_body: dict[Body, list[Point]] = {}
    for joint in joints:
        if joint.places is not None and chassis in joint.places.bodies:
            number = joint.places.bodies.index(chassis)
            x, y, z = (float(v) for v in np.asarray(joint.places.points[number]))
            points_by_body.setdefault(joint.places.bodies[1 - number], []).append((x, y, z))
    for points in points_by_body.values():
        for a, b in combinations(points, 2):
            if a[1] + b[1] >= 0.0:
                yield a, b
