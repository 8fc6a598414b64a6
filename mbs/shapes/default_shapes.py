"""Default shapes of bodies and joints: tubes and plates through joints, wheels, springs, rails and pins."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from typing import Any

import numpy as np

from mbs.common.checks import Vector
from mbs.model.body import Body
from mbs.model.carried_parts import Spin
from mbs.model.flexible import FlexibleBody, Interface
from mbs.model.joints.joint import RollingBody, RollingSpin
from mbs.model.model import Model
from mbs.model.shapes import origin_of
from mbs.shapes.frames import FrameNames, numbers
from mbs.shapes.joint_points import POINT_TOLERANCE, JointGeometry, Line, Pivot, Slide, distinct_points, sensed_points

COLORS = ("#c8553d", "#3d7ea6", "#6a994e", "#e09f3e", "#7d5ba6", "#2a9d8f", "#b56576", "#8d99ae")
GROUND, RAIL, SPRING, ROD = "#4a4e57", "#8b9099", "#d9a441", "#aeb4bd"
TUBE_RADIUS = 0.014
"""Radius of a tube, relative to the extent of the drawing."""
MAX_RADIUS = 0.09
"""Largest radius of a tube, relative to the length of its body."""
MIN_TRIANGLE_HEIGHT = 0.2  # relative to its longest side, below which it is drawn as tubes
MIN_SLIDER_LENGTH = 1.1  # distance of the joints of a slider / edge of its box, below which the box is drawn
MAX_OVERHANG = 0.1  # of a centre of mass beyond the ends of a tube, relative to the length of the tube

Shape = dict[str, Any]


@dataclass(frozen=True)
class Defaults:
    """Makes the default shapes of a model."""

    model: Model
    names: FrameNames
    geometry: JointGeometry
    extent: float
    """Size of the drawing, m."""

    @cached_property
    def tube_radius(self) -> float:
        """Radius of tubes, m: small relative to the extent and to the longest body."""
        bodies = [points for frame, points in self.geometry.points.items() if frame != "ground" and len(points) > 1]
        longest = max((float(np.linalg.norm(np.ptp(points, axis=0))) for points in bodies), default=0.0)
        return min(TUBE_RADIUS * self.extent, MAX_RADIUS * longest) if longest > 0.0 else TUBE_RADIUS * self.extent

    @cached_property
    def _rolling_discs(self) -> dict[Body, list[RollingBody]]:
        """Rolling discs by their body."""
        discs: dict[Body, list[RollingBody]] = {}
        for joint in self.model.joints:
            if isinstance(joint.rolls, RollingBody):
                discs.setdefault(joint.rolls.body, []).append(joint.rolls)
        return discs

    @cached_property
    def _sensed_points(self) -> dict[Body, list[Vector]]:
        return sensed_points(self.model)

    @cached_property
    def _turning_frames(self) -> set[str]:
        """Frames with a revolute, spherical or universal joint."""
        return {self.names.of_body(body) for pivot in self.geometry.pivots for body in pivot.bodies}

    @cached_property
    def _slides_by_frame(self) -> dict[str, list[Slide]]:
        """Sliding joints by the frame of the sliding body."""
        slides: dict[str, list[Slide]] = {}
        for slide in self.geometry.slides:
            slides.setdefault(self.names.of_body(slide.bodies[0]), []).append(slide)
        return slides

    @cached_property
    def _mean_point(self) -> Vector:
        """Mean of all points at which joints, wheels and springs act, m."""
        return np.asarray(np.mean([p for points in self.geometry.points.values() for p in points], axis=0))

    def all(self, drawn: set[str], named: set[str]) -> list[Shape]:
        """Shapes of all frames and joints but those that the user draws: `drawn` frames and `named` shapes."""
        shapes: list[Shape] = []
        for body in self.model.bodies:
            frame = self.names.of_body(body)
            if frame not in drawn:
                color = COLORS[body.number % len(COLORS)]
                shapes += [
                    s | {"body": body.name, "color": s.get("color", color)} for s in self._body_shapes(body, frame)
                ]
        for spin in (s for s in self.model.spins if s.name in self.names.turns):  # a lookup-table wheel is not drawn
            if self.names.turns[spin.name] not in drawn:
                shapes.append(self._wheel_shape(spin) | {"body": spin.name})
        for line in self.geometry.lines:
            if line.name not in named:
                shapes += self._line_shapes(line)
        for pivot in self.geometry.pivots:
            if pivot.joint.name not in named:
                shapes += self._pivot_shapes(pivot, drawn)
        for slide in self.geometry.slides:
            if slide.joint.name not in named:
                shapes += self._rail_shapes(slide, drawn)
        return shapes

    def _body_shapes(self, body: Body, frame: str) -> list[Shape]:
        """Shapes of a body by its kind, its points and its inertia."""
        if isinstance(body, FlexibleBody):
            return []  # its beams are drawn
        discs = self._rolling_discs.get(body)
        if discs:
            return [
                {
                    "kind": "wheel",
                    "frame": frame,
                    "at": numbers(disc.centre - origin_of(body)),
                    "axis": numbers(disc.axis),
                    "radius": disc.radius,
                    "width": 0.15 * disc.radius,
                    "rim": 0.85 * disc.radius,
                }
                for disc in discs
            ]
        if body.is_point:
            return [{"kind": "sphere", "frame": frame, "at": [0.0, 0.0, 0.0], "radius": 2.5 * self.tube_radius}]
        least = POINT_TOLERANCE * self.extent
        com = origin_of(body)
        points = distinct_points(self.geometry.points.get(frame, []), least)
        if len(points) < 2:
            points = distinct_points([*points, *self._sensed_points.get(body, [])], least)
            outer_points = [p for p in points if np.linalg.norm(p - com) > least]
            if not outer_points:
                return [self._inertia_shape(body, frame)]
            if len(points) == 1:
                return [*self._tube_shapes(frame, [*points, com], com), self._com_ball(frame)]
        if (
            self._is_slider(frame)
            and np.linalg.norm(np.ptp(points, axis=0)) < MIN_SLIDER_LENGTH * self._inertia_box(body).max()
        ):
            return [self._inertia_shape(body, frame)]
        shapes = self._plate_shapes(frame, points, com) or self._tube_shapes(frame, points, com)
        if len(points) > 2:
            return shapes
        if _is_beyond(com, points[0], points[1]):
            shapes = [*self._tube_shapes(frame, [*points, com], com), self._com_ball(frame)]
        return shapes + [self._slider_shape(frame, com, slide) for slide in self._slides_by_frame.get(frame, [])]

    def _is_slider(self, frame: str) -> bool:
        """Whether all joints of a frame are sliding joints."""
        return frame in self._slides_by_frame and frame not in self._turning_frames

    def _inertia_box(self, body: Body) -> Vector:
        """Edges of the box with the second moments of a body along the earth axes as drawn, m."""
        J = np.diag(body.second_moment) / body.mass
        if self.model.dimension == 2:
            J = J + np.array([0.0, 0.0, 0.25 * J[0]])
        return np.asarray(np.sqrt(12.0 * np.clip(J, 0.0, None)))

    def _com_ball(self, frame: str) -> Shape:
        """Sphere at the centre of mass."""
        return {"kind": "sphere", "frame": frame, "at": [0.0, 0.0, 0.0], "radius": 2.2 * self.tube_radius}

    def _tube_shapes(self, frame: str, points: Sequence[Vector], com: Vector) -> list[Shape]:
        """Tubes along the shortest tree through the points."""
        radius = min(self.tube_radius, MAX_RADIUS * float(np.linalg.norm(np.ptp(points, axis=0))))
        return [
            {"kind": "tube", "points": [[frame, numbers(p - com)] for p in (points[i], points[j])], "radius": radius}
            for i, j in _shortest_tree(points)
        ]

    def _plate_shapes(self, frame: str, points: Sequence[Vector], com: Vector) -> list[Shape]:
        """Plate if there are three points that form a triangle that is not slender."""
        if len(points) != 3:
            return []
        sides = [float(np.linalg.norm(a - b)) for a, b in combinations(points, 2)]
        height = float(np.linalg.norm(np.cross(points[1] - points[0], points[2] - points[0]))) / max(sides)
        if height < MIN_TRIANGLE_HEIGHT * max(sides):
            return []
        thickness = min(self.tube_radius, MAX_RADIUS * max(sides))
        return [{"kind": "plate", "points": [[frame, numbers(p - com)] for p in points], "thickness": thickness}]

    def _inertia_shape(self, body: Body, frame: str) -> Shape:
        """Box with the principal moments and axes of inertia of a body."""
        J = body.second_moment / body.mass
        oblique = not np.allclose(J, np.diag(np.diag(J)), atol=1e-9 * float(np.abs(J).max()))
        edges, axes = self._inertia_box(body), np.eye(3)
        if oblique:
            values, axes = np.linalg.eigh(J)
            axes = axes * (1.0 if np.linalg.det(axes) > 0.0 else -1.0)
            edges = np.sqrt(12.0 * np.clip(values, 0.0, None))
        least = 0.02 * max(float(edges.max()), self.tube_radius)
        size = np.clip(edges, least, 0.35 * self.extent if len(self.model.bodies) > 1 else None)
        shape: Shape = {"kind": "box", "frame": frame, "at": [0.0, 0.0, 0.0], "size": numbers(size)}
        return shape | ({"axes": [numbers(column) for column in axes.T]} if oblique else {})

    def _slider_shape(self, frame: str, com: Vector, slide: Slide) -> Shape:
        """Box around the rail of a sliding joint."""
        edge = 4.0 * self.tube_radius
        axes = _axes_along(slide.axis)
        return {
            "kind": "box",
            "frame": frame,
            "at": numbers(slide.point - com),
            "size": [1.6 * edge, edge, edge],
            "axes": [numbers(column) for column in axes.T],
        }

    def _wheel_shape(self, spin: Spin) -> Shape:
        """Wheel of a spin with the radius of its tyre or of its rolling joint."""
        rolling = [
            j.rolls.radius for j in self.model.joints if isinstance(j.rolls, RollingSpin) and j.rolls.spin is spin
        ]
        tyres = [
            dict(zip(r.real_names, r.real, strict=False)).get("radius")
            for r in self.model.elements
            if r.signals and spin.index in r.signals[-1].terms and "radius" in r.real_names
        ]
        thin = bool(rolling)
        radius = next((float(r) for r in [*tyres, *rolling, spin.rolling_radius] if r), 0.1 * self.extent)
        return {
            "kind": "wheel",
            "frame": self.names.turns[spin.name],
            "axis": numbers(spin.axis_reference),
            "radius": radius,
            "width": (0.1 if thin else 0.6) * radius,
            "rim": (0.88 if thin else 0.62) * radius,
        }

    def _line_shapes(self, line: Line) -> list[Shape]:
        """Actuator, rod, spring or damper between two anchors."""
        ends = [list(end) for end in line.ends]
        if line.drives:
            return [{"kind": "damper", "ends": ends, "radius": 1.2 * self.tube_radius, "color": ROD, "name": line.name}]
        if line.record is None:
            return [{"kind": "tube", "points": ends, "radius": 0.6 * self.tube_radius, "color": ROD, "name": line.name}]
        real = dict(zip(line.record.real_names, line.record.real, strict=False))
        spring = {
            "kind": "spring",
            "ends": ends,
            "radius": 2.0 * self.tube_radius,
            "wire": 0.7 * self.tube_radius,
            "coils": 8,
        }
        damper = {"kind": "damper", "ends": ends, "radius": 1.0 * self.tube_radius}
        both = "stiffness" not in real
        shapes = [s for s, key in ((spring, "stiffness"), (damper, "damping")) if both or real.get(key, 0.0) > 0.0]
        return [s | {"color": SPRING if s is spring else ROD, "name": line.name} for s in shapes]

    def _pivot_shapes(self, pivot: Pivot, drawn: set[str]) -> list[Shape]:
        """Cylinder along the axis of a revolute joint, sphere for other joints; larger and darker on the ground."""
        bodies = sorted(pivot.bodies, key=lambda b: not b.is_ground)
        if any(isinstance(b, (FlexibleBody, Interface)) for b in bodies) and not bodies[0].is_ground:
            return []
        if not bodies[0].is_ground and self.names.of_body(bodies[0]) in drawn:
            return []
        grounded = bodies[0].is_ground
        frame, local = self.names.anchor(bodies[0], pivot.point)
        radius = (1.7 if grounded else 1.25) * self.tube_radius
        appearance: Shape = {"color": GROUND if grounded else RAIL, "name": pivot.joint.name}
        if pivot.axis is None:
            return [{"kind": "sphere", "frame": frame, "at": local, "radius": 1.2 * radius} | appearance]
        half_length = (1.8 if grounded else 1.5) * self.tube_radius * pivot.axis / np.linalg.norm(pivot.axis)
        ends = [numbers(np.array(local) - half_length), numbers(np.array(local) + half_length)]
        return [{"kind": "cylinder", "frame": frame, "ends": ends, "radius": radius} | appearance]

    def _rail_shapes(self, slide: Slide, drawn: set[str]) -> list[Shape]:
        """Cylinder along the axis of a sliding joint, on the body that has the axis."""
        base = slide.bodies[1]
        unit = slide.axis / np.linalg.norm(slide.axis)
        middle = slide.point
        if base.is_ground:
            middle = slide.point + np.dot(self._mean_point - slide.point, unit) * unit
        frame, local = self.names.anchor(base, middle)
        if not base.is_ground and (frame in drawn or len(self.geometry.points.get(frame, [])) > 2):
            return []
        half_length = (1.2 if base.is_ground else 0.25) * self.extent * unit
        ends = [numbers(np.array(local) - half_length), numbers(np.array(local) + half_length)]
        return [
            {"kind": "cylinder", "frame": frame, "ends": ends, "radius": 0.4 * self.tube_radius}
            | {"color": RAIL, "name": slide.joint.name}
        ]


def _shortest_tree(points: Sequence[Vector]) -> list[tuple[int, int]]:
    """Edges of the minimum spanning tree of points, as pairs of indices (Prim's algorithm)."""
    tree, pairs = [0], []
    while len(tree) < len(points):
        remaining = [k for k in range(len(points)) if k not in tree]
        i, j = min(
            ((i, j) for i in tree for j in remaining), key=lambda p: float(np.linalg.norm(points[p[0]] - points[p[1]]))
        )
        pairs.append((i, j))
        tree.append(j)
    return pairs


def _is_beyond(com: Vector, a: Vector, b: Vector) -> bool:
    """Whether a centre of mass lies beyond the ends of a tube from a to b."""
    fraction = float(np.dot(com - a, b - a) / np.dot(b - a, b - a))
    return not -MAX_OVERHANG <= fraction <= 1.0 + MAX_OVERHANG


def _axes_along(axis: Vector) -> Vector:
    """Right-handed axes (3, 3), as columns, the first along `axis`."""
    x = axis / np.linalg.norm(axis)
    auxiliary = np.eye(3)[int(np.argmin(np.abs(x)))]
    y = np.cross(auxiliary, x)
    y = y / np.linalg.norm(y)
    return np.column_stack([x, y, np.cross(x, y)])
