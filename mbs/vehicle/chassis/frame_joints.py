"""Finds the joints of a frame on which suspension, drive and ground act."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from mbs.common.errors import ModelError
from mbs.vehicle.chassis.attachments import Attachments
from mbs.vehicle.chassis.frames.frame_section import FrameSection, Structure
from mbs.vehicle.chassis.section import Chassis
from mbs.vehicle.side import Point

POINT_TOLERANCE = 1e-5
"""Largest distance of a hard point from its joint, m, for coordinates with six digits."""
Pair: TypeAlias = "tuple[str, ...]"
"""A joint and its image, or one joint on the centre plane."""


@dataclass(frozen=True)
class FrameJoints:
    """Joints of a frame by their use in the car."""

    interfaces: dict[str, Point]
    """Joints of the suspension with their hard points, m; each left joint is followed by its image."""
    held: tuple[tuple[str, str], ...]
    """Pairs of interfaces at a constant distance."""
    drive: tuple[Pair, ...]
    """Pairs of joints with the reaction of the drive: front, rear, top."""
    ground: tuple[Pair, ...]
    """Pairs of joints with the forces of the ground on the chassis."""
    reference: str | tuple[str, ...]
    """Node, or three nodes, of the floating frame."""
    accelerometers: dict[str, Point]
    """Joints of accelerometers with their points, m."""


class JointFinder:
    """Finds joints by the positions of hard points, and the defaults of omitted keys.

    `keys`: key paths of hard points and accelerometers, for messages.
    """

    def __init__(
        self, section: FrameSection, structure: Structure, attached: Attachments, keys: Mapping[Point, str]
    ) -> None:
        self._section, self._structure, self._keys = section, structure, keys
        self._constant_pairs = attached.held
        # in the order of the file: the order of modes and loads does not depend on the code of a template
        order = list(keys)
        self._axles = [sorted(p, key=lambda x: order.index(x) if x in keys else len(order)) for p in attached.axles]
        self._names = list(structure.joints)
        self._places = np.array(list(structure.joints.values()))

    def joints(self, chassis: Chassis, driven: int) -> FrameJoints:
        """Find the joints of the frame for the car.

        `chassis`: chassis with floating frame and accelerometers; `driven`: index of the driven axle, 0 front, 1 rear.
        Raises `ModelError` if a hard point is not a joint, a joint does not exist, or a joint must be given.
        """
        interfaces, arms = {}, []
        for point in dict.fromkeys((*self._axles[0], *self._axles[1])):
            for position in (point, _image(point)):
                interfaces[self._joint_at(position, point)] = position
        for a, b in self._constant_pairs:
            arms.append((self._joint_at(a), self._joint_at(b)))
            if a[1] + b[1] > 0.0:
                arms.append((self._joint_at(_image(a), a), self._joint_at(_image(b), b)))
        drive = self._drive_joints(driven)
        ground = self._named_joints("ground_mounts") or (self._pair(self._axles[1 - driven][0]), *drive)
        accelerometers = {self._joint_at(point): point for point in chassis.accelerometers.values()}
        return FrameJoints(
            interfaces, tuple(arms), drive, ground, self._reference_joint(chassis.reference), accelerometers
        )

    def _drive_joints(self, driven: int) -> tuple[Pair, ...]:
        """Joints with the reaction of the drive, by default of an arm of the driven axle and of its highest point."""
        named_pairs = self._named_joints("drive_mounts")
        if named_pairs:
            return named_pairs
        points = self._axles[driven]
        arms = [pair for pair in self._constant_pairs if set(pair) <= set(points)]
        if not arms:
            raise ModelError(
                f"{self._section.key('drive_mounts')} is missing: no arm of the driven axle has two pivots on the "
                "frame; name three left joints that take the reaction of the drive, front, rear and top."
            )
        rear, front = sorted(arms[0])
        return tuple(self._pair(point) for point in (front, rear, max(points, key=lambda p: p[2])))

    def _reference_joint(self, position: Point) -> str | tuple[str, ...]:
        """Node of the floating frame at a point, or the nodes that the file names."""
        key, model = self._section.key("reference"), self._structure.model
        reference = self._section.reference
        if reference is None:
            reference = self._nearest(position, "chassis.reference")
        first = reference if isinstance(reference, str) else reference[0]
        for name in (reference,) if isinstance(reference, str) else reference:
            if name not in model.names:
                raise ModelError(f"{key} names {name!r}; the frame has no such joint.")
        gap = float(np.linalg.norm(model.positions[model.node(first)] - position))
        if gap > POINT_TOLERANCE:
            raise ModelError(f"{key} names {first}, which is {gap:.3g} m away from chassis.reference.")
        if isinstance(reference, str) and (model.dof[model.node(reference), 3:] < 0).any():
            raise ModelError(f"{key} must name three nodes that span a triangle: node {reference} has no rotations.")
        return reference

    def _named_joints(self, field: str) -> tuple[Pair, ...]:
        """Joints of a field of the file, with their images."""
        pairs = []
        for name in getattr(self._section, field) or ():
            if name not in self._names:
                raise ModelError(f"{self._section.key(field)} names {name!r}; the frame has no such joint.")
            x, y, z = (float(v) for v in self._structure.joints[name])
            label = f"{self._section.key(field)}: the image of {name}"
            pairs.append((name, self._nearest((x, -y, z), label)) if y else (name,))
        return tuple(pairs)

    def _pair(self, point: Point) -> Pair:
        """Joints at a hard point and at its image."""
        return tuple(dict.fromkeys((self._joint_at(point), self._joint_at(_image(point), point))))

    def _joint_at(self, position: Point, point: Point | None = None) -> str:
        """Joint at a position: a hard point, or the image of `point`."""
        key = self._keys.get(point or position, "A point of the suspension on the chassis")
        return self._nearest(position, key if point in (None, position) else f"The image of {key}")

    def _nearest(self, position: Point, subject: str) -> str:
        """Joint at a position, m. `subject`: key path of the point. Raises `ModelError` if there is none."""
        gaps = np.linalg.norm(self._places - position, axis=1)
        nearest = int(gaps.argmin())
        if gaps[nearest] > POINT_TOLERANCE:
            where = ", ".join(f"{v:g}" for v in position)
            raise ModelError(
                f"{subject} is at ({where}) m, where the frame has no joint; the nearest is {self._names[nearest]}, "
                f"{gaps[nearest]:.3g} m away."
            )
        return self._names[nearest]


def _image(point: Point) -> Point:
    """Mirror image of a point."""
    return (point[0], -point[1], point[2])
