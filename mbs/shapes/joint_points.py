"""Points of bodies at which joints, wheels and springs act, for the default shapes of a model."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from mbs.common.affine import Affine
from mbs.common.checks import Vector
from mbs.common.vectors import in_space
from mbs.elements.record import ElementRecord
from mbs.kernel.header.enumerations import ElementType, SensorType
from mbs.model.body import Body
from mbs.model.carried_parts import SlidingPoint
from mbs.model.joints.joint import Joint
from mbs.model.model import Model
from mbs.model.shapes import origin_of
from mbs.shapes.frames import Anchor, FrameNames, anchors_of_difference, numbers, place_drawn

POINT_TOLERANCE = 1e-6  # distance relative to the extent, up to which points coincide
LINE_ELEMENTS = (ElementType.SPRING_DAMPER, ElementType.SPRING_DAMPER_TABLE)


@dataclass(frozen=True)
class Line:
    """A spring, damper, rod or actuator between two anchors."""

    name: str
    ends: tuple[Anchor, Anchor]
    record: ElementRecord | None = None
    drives: bool = False


@dataclass(frozen=True)
class Pivot:
    """A revolute, spherical or universal joint: its bodies, and its point and axis as drawn (None: no single axis)."""

    joint: Joint
    bodies: tuple[Body, Body]
    point: Vector
    axis: Vector | None


@dataclass(frozen=True)
class Slide:
    """A joint whose point on the first body slides along an axis of the second, as drawn."""

    joint: Joint
    bodies: tuple[Body, Body]
    point: Vector
    axis: Vector


@dataclass
class JointGeometry:
    """Points at which joints, wheels and springs act on the bodies of a model, and the parts between them."""

    points: dict[str, list[Vector]] = field(default_factory=dict)
    """Points by frame, earth axes as drawn, m."""
    pivots: list[Pivot] = field(default_factory=list)
    slides: list[Slide] = field(default_factory=list)
    lines: list[Line] = field(default_factory=list)
    sliding: list[str] = field(default_factory=list)
    """Names of rods with an end moved by a driving function without a sensor; they are not drawn."""
    frames: dict[str, dict[str, Any]] = field(default_factory=dict)
    """Frames of the ends of rods moved by driving functions with sensors, by name."""


def joint_geometry(model: Model, names: FrameNames) -> JointGeometry:
    """Joints, springs and wheels of a model, with their points on its bodies."""
    geometry, drawn = JointGeometry(), model.drawn()
    for joint in model.joints:
        action = joint.ends or joint.actuator
        if action is None:
            continue
        bodies = action.bodies
        points = [place_drawn(drawn, p) for p in action.points]
        if action.rod:
            ends = (names.anchor(bodies[0], points[0]), names.anchor(bodies[1], points[1]))
            if joint.slide is not None:
                number, slide = joint.slide
                sliding = _sliding_frames(model, names, drawn, slide)
                if not sliding:
                    geometry.sliding.append(joint.name)
                    continue
                geometry.frames |= sliding
                end = list(sliding)[-1], [0.0, 0.0, 0.0]
                ends = (end, ends[1]) if number == 0 else (ends[0], end)
            geometry.lines.append(Line(joint.name, ends, drives=joint.actuator is not None))
        elif action.slides and action.axis is not None:
            geometry.slides.append(Slide(joint, bodies, points[0], place_drawn(drawn, action.axis)))
        elif joint.type in ("revolute", "spherical", "universal"):
            geometry.pivots.append(Pivot(joint, bodies, points[0], _joint_axis(model.dimension, drawn, joint)))
        for body, point in zip(bodies, points, strict=True):
            geometry.points.setdefault(names.of_body(body), []).append(point)
    origins = {names.of_body(b): origin_of(b) for b in model.bodies} | {"ground": np.zeros(3)}
    starts = {body.start: body for body in model.bodies}
    for record in model.elements:
        if record.type not in LINE_ELEMENTS:
            continue
        if (line_ends := anchors_of_difference(model, names, starts, drawn, record.signals)) is not None:
            geometry.lines.append(Line(record.name, line_ends, record))
            for frame, local in line_ends:
                geometry.points.setdefault(frame, []).append(origins[frame] + np.array(local))
    for spin in (s for s in model.spins if not s.carrier.is_lookup_table):
        geometry.points.setdefault(names.of_body(spin.carrier), []).append(origin_of(spin))
    return geometry


def _driving_sensor(model: Model, guide: int) -> str:
    """Name of the sensor of a driving function in m; empty if there is none."""
    for sensor in model.sensors:
        if sensor.type == SensorType.DRIVING and list(sensor.integers) == [guide, 0] and list(sensor.reals) == [1.0]:
            return sensor.name
    return ""


def _sliding_frames(model: Model, names: FrameNames, drawn: Vector, slide: SlidingPoint) -> dict[str, dict[str, Any]]:
    """Frames of a sliding point by name, each the parent of the next; empty if a driving function has no sensor."""
    parent, at = names.anchor(slide.body, place_drawn(drawn, slide.start))
    names_in_use = {"ground", *names.bodies.values(), *names.turns.values()}
    name = f"end of {slide.name}" if slide.name in names_in_use else slide.name
    frames: dict[str, dict[str, Any]] = {}
    for k, (direction, guide) in enumerate(slide.ways):
        sensor = _driving_sensor(model, guide)
        if not sensor:
            return {}
        last = k == len(slide.ways) - 1
        frame, start = name if last else f"{name} {k + 1}", float(model.guides[guide].start)
        along = numbers(place_drawn(drawn, direction))
        frames[frame] = {"parent": parent, "at": at, "direction": along, "way": sensor, "start": start}
        parent, at = frame, [0.0, 0.0, 0.0]
    return frames


def _joint_axis(dimension: int, drawn: Vector, joint: Joint) -> Vector | None:
    """Axis of a revolute joint as drawn; None for other joints."""
    if joint.type != "revolute":
        return None
    if dimension == 2:
        return np.array([0.0, 0.0, 1.0])
    return None if joint.ends is None or joint.ends.axis is None else place_drawn(drawn, joint.ends.axis)


def sensed_points(model: Model) -> dict[Body, list[Vector]]:
    """Points of rigid bodies whose position a sensor reads, by body, earth axes as drawn, m."""
    bodies = {body.start + k: body for body in model.bodies for k in range(model.dimension)}
    points: dict[Body, list[Vector]] = {}
    for sensor in model.sensors:
        if sensor.type != SensorType.SIGNAL or len(sensor.signals) != 1 or list(sensor.reals) != [1.0]:
            continue
        for body in {bodies[i] for i in sensor.signals[0].terms if i in bodies}:
            local = _sensed_point(body, sensor.signals[0])
            if local is not None:
                points.setdefault(body, []).append(in_space(body.com) + local)
    return points


def _sensed_point(body: Body, signal: Affine) -> Vector | None:
    """Point of a rigid body, in its axes, m, of which a signal is a coordinate; None if there is none."""
    d, s = body.dimension, body.start
    terms = dict(signal.terms)
    k = next((k for k in range(d) if terms.pop(s + k, None) == 1.0), -1)
    if k < 0 or signal.constant != 0.0:
        return None
    if d == 3:
        point = np.array([terms.pop(s + 3 * (m + 1) + k, 0.0) for m in range(3)])
    else:
        x, y = terms.pop(s + 2 + k, 0.0), terms.pop(s + 3 - k, 0.0)
        point = np.array([x, -y if k == 0 else y, 0.0])
    return None if terms else point


def distinct_points(points: Sequence[Vector], tolerance: float) -> list[Vector]:
    """Points without those within `tolerance`, m, of an earlier one."""
    distinct: list[Vector] = []
    for p in points:
        if all(np.linalg.norm(p - q) > tolerance for q in distinct):
            distinct.append(p)
    return distinct
