"""Joints of a frame on which suspension, drive and ground act."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from mbs.common.errors import ModelError
from mbs.vehicle.chassis.attachments import Attachments
from mbs.vehicle.chassis.frames.frame_section import FrameSection, Structure
from mbs.vehicle.chassis.section import Chassis
from mbs.vehicle.side import Point

SAME_PLACE = 1e-5
"""A hard point is a joint of the frame if it is no farther from it, m: coordinates printed with six digits pass."""
Pair: TypeAlias = "tuple[str, ...]"
"""A joint and its image, or one on the centre plane alone."""


@dataclass(frozen=True)
class FrameJoints:
    """Names of joints."""

    interfaces: dict[str, Point]
    """Where the suspension hangs, with the hard points there, m; each joint of the left is followed by its image."""
    held: tuple[tuple[str, str], ...]
    """Pairs of them whose distance a part of the suspension holds."""
    drive: tuple[Pair, ...]
    """Left and right joints that take the reaction of the drive: front, rear, top."""
    ground: tuple[Pair, ...]
    """Left and right joints that take forces of the ground on the chassis."""
    reference: str | tuple[str, ...]
    """What carries the floating frame."""
    accelerometers: dict[str, Point]
    """Where accelerometers sit, m."""


class JointFinder:
    """Matches hard points and joints by place, and derives what the file leaves out.

    `keys`: key paths of hard points and accelerometers, for messages.
    """

    def __init__(
        self, section: FrameSection, structure: Structure, attached: Attachments, keys: Mapping[Point, str]
    ) -> None:
        self._section, self._structure, self._keys = section, structure, keys
        self._held = attached.held
        # in the order of the file, so that the order of modes and loads does not hang on that of a template's lines
        order = list(keys)
        self._axles = [sorted(p, key=lambda x: order.index(x) if x in keys else len(order)) for p in attached.axles]
        self._names = list(structure.joints)
        self._places = np.array(list(structure.joints.values()))

    def joints(self, chassis: Chassis, driven: int) -> FrameJoints:
        """Joints of the frame that the car needs.

        `chassis`: with the place of the floating frame and accelerometers; `driven`: 0: the front axle is driven, 1:
        the rear one. Raises `ModelError`: a hard point is not a joint, a joint that the file names does not exist, or
        one must be named.
        """
        interfaces, arms = {}, []
        for point in dict.fromkeys((*self._axles[0], *self._axles[1])):
            for position in (point, _image(point)):
                interfaces[self._joint_at(position, point)] = position
        for a, b in self._held:
            arms.append((self._joint_at(a), self._joint_at(b)))
            if a[1] + b[1] > 0.0:
                arms.append((self._joint_at(_image(a), a), self._joint_at(_image(b), b)))
        drive = self._drive(driven)
        ground = self._named("ground_mounts") or (self._pair(self._axles[1 - driven][0]), *drive)
        accelerometers = {self._joint_at(point): point for point in chassis.accelerometers.values()}
        return FrameJoints(interfaces, tuple(arms), drive, ground, self._reference(chassis.reference), accelerometers)

    def _drive(self, driven: int) -> tuple[Pair, ...]:
        named_pairs = self._named("drive_mounts")
        if named_pairs:
            return named_pairs
        points = self._axles[driven]
        arms = [pair for pair in self._held if set(pair) <= set(points)]
        if not arms:
            raise ModelError(
                f"{self._section.key('drive_mounts')} is missing: no arm of the driven axle has two pivots on the "
                "frame; name three left joints that take the reaction of the drive, front, rear and top."
            )
        rear, front = sorted(arms[0])
        return tuple(self._pair(point) for point in (front, rear, max(points, key=lambda p: p[2])))

    def _reference(self, position: Point) -> str | tuple[str, ...]:
        key, model = self._section.key("reference"), self._structure.model
        reference = self._section.reference
        if reference is None:
            reference = self._nearest(position, "chassis.reference")
        first = reference if isinstance(reference, str) else reference[0]
        for name in (reference,) if isinstance(reference, str) else reference:
            if name not in model.names:
                raise ModelError(f"{key} names {name!r}; the frame has no such joint.")
        gap = float(np.linalg.norm(model.positions[model.node(first)] - position))
        if gap > SAME_PLACE:
            raise ModelError(f"{key} names {first}, which is {gap:.3g} m away from chassis.reference.")
        if isinstance(reference, str) and (model.dof[model.node(reference), 3:] < 0).any():
            raise ModelError(f"{key} must name three nodes that span a triangle: node {reference} has no rotations.")
        return reference

    def _named(self, field: str) -> tuple[Pair, ...]:
        """Joints that the file names, with their images."""
        pairs = []
        for name in getattr(self._section, field) or ():
            if name not in self._names:
                raise ModelError(f"{self._section.key(field)} names {name!r}; the frame has no such joint.")
            x, y, z = (float(v) for v in self._structure.joints[name])
            label = f"{self._section.key(field)}: the image of {name}"
            pairs.append((name, self._nearest((x, -y, z), label)) if y else (name,))
        return tuple(pairs)

    def _pair(self, point: Point) -> Pair:
        return tuple(dict.fromkeys((self._joint_at(point), self._joint_at(_image(point), point))))

    def _joint_at(self, position: Point, point: Point | None = None) -> str:
        """Joint at a hard point, or at the image of one."""
        key = self._keys.get(point or position, "A point of the suspension on the chassis")
        return self._nearest(position, key if point in (None, position) else f"The image of {key}")

    def _nearest(self, position: Point, what: str) -> str:
        gaps = np.linalg.norm(self._places - position, axis=1)
        nearest = int(gaps.argmin())
        if gaps[nearest] > SAME_PLACE:
            where = ", ".join(f"{v:g}" for v in position)
            raise ModelError(
                f"{what} is at ({where}) m, where the frame has no joint; the nearest is {self._names[nearest]}, "
                f"{gaps[nearest]:.3g} m away."
            )
        return self._names[nearest]


def _image(point: Point) -> Point:
    return (point[0], -point[1], point[2])
