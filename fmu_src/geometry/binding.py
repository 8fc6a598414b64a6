"""Frames of a drawing moved by the sensors of its System: by pose outputs, by angles, or by points of other frames."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np

import mbs
from fmu_src.geometry.sensor_rows import Array, SensorRows
from mbs.system.drawing import BodyPlace, matrices

Frame = dict[str, Any]
Shared = tuple[str, Sequence[float], str, Sequence[float]]
"""A point that two frames share: frame and place in it, twice."""
GROUND = "ground"
LEAST_HEIGHT = 1e-3  # over the longest side, of a triangle that determines a frame
BUILD_ALL = "build the FMU with --poses all"


@dataclass(frozen=True)
class Bound:
    """Frames that variables move."""

    frames: dict[str, Frame]
    """As the scene has them."""
    moved: dict[str, Array]
    """Each of shape (3,): place of the drawing's origin in the frame, where it is not 0, m."""
    lost: dict[str, str]
    """Frames that no variable moves, with the reason."""
    amplitudes: dict[str, str]
    """Variables of amplitudes by the columns of the drawing."""


def bind(system: mbs.System, frames: Mapping[str, Frame], shared: Sequence[Shared]) -> Bound:
    """Find the variables that move the frames of a drawing. `shared`: points that frames share."""
    rows, bound = SensorRows(system), Bound({}, {}, {}, {})
    assert system.drawing is not None, "asked for before"
    bodies = {amplitudes.columns[0]: amplitudes for amplitudes in system.drawing.places.bodies}
    for name, frame in frames.items():
        if "position" in frame and frame["position"][0] in rows.names:
            bound.frames[name] = dict(frame)  # sensors place it in the model already
        elif "position" in frame:
            _bind_by_sensors(rows, name, frame, bodies[frame["position"][0]], bound)
    _bind_by_points(frames, shared, bound)
    turns = {turn.column: turn for turn in system.drawing.places.turns}
    for name, frame in frames.items():
        if "parent" not in frame:
            continue
        key = "way" if "way" in frame else "angle"
        column: str | None = frame[key]
        if column not in rows.names:
            turn = turns.get(str(column))
            column = None if turn is None else (rows.spin_angle if turn.absolute else rows.angle)(turn.row)
        if column is None:
            bound.lost[name] = f"no output is its angle; {BUILD_ALL}"
        elif frame["parent"] in bound.lost:
            bound.lost[name] = bound.lost[frame["parent"]]
        else:
            at = np.array(frame.get("at", (0.0, 0.0, 0.0))) + bound.moved.get(frame["parent"], 0.0)
            bound.frames[name] = dict(frame) | {key: column, "at": [float(x) for x in at]}
    for amplitudes in system.drawing.places.amplitudes:
        for k, column in enumerate(amplitudes.columns):
            angle = rows.angle(amplitudes.row + k)
            if angle is not None:
                bound.amplitudes[column] = angle
    return bound


def _bind_by_sensors(rows: SensorRows, name: str, frame: Frame, place: BodyPlace, bound: Bound) -> None:
    """Bind the frame of a body whose pose is an output, at any of its points."""
    body = rows.body(place)
    orientations = [
        names for names, axes in rows.quaternions() if body.axes is not None and np.allclose(axes, body.axes)
    ]
    poses = []
    for names in rows.points():
        offset = rows.place_of(names, body)
        if offset is None:
            continue
        own_quaternion = tuple(f"{names[0][:-1]}q{c}" for c in "wxyz")
        if body.axes is None:
            poses += [(names, offset, own_quaternion)] if rows.is_identity(own_quaternion) else []
        elif orientations:
            poses.append((names, offset, own_quaternion if own_quaternion in orientations else orientations[0]))
    if not poses:
        return
    names, offset, quaternion = next((f for f in poses if f[2][0] == f"{f[0][0][:-1]}qw"), poses[0])
    shift = -np.where(np.abs(offset) < 1e-12, 0.0, offset)
    if np.any(shift):
        bound.moved[name] = shift
    start = frame.get("start")
    bound.frames[name] = {"position": list(names), "quaternion": list(quaternion)} | (
        {} if start is None else {"start": [_shifted_start(start, -shift), start[1]]}
    )


def _shifted_start(start: Sequence[Sequence[float]], local: Array) -> list[float]:
    """Position of a local point at the start, m."""
    turned = matrices(np.array([start[1]]))[0] @ local
    return [float(x) + 0.0 for x in np.array(start[0]) + turned]


def _bind_by_points(frames: Mapping[str, Frame], shared: Sequence[Shared], bound: Bound) -> None:
    """Bind frames that share three points with bound frames, one after the other."""
    unbound = [name for name, frame in frames.items() if "position" in frame and name not in bound.frames]
    has_new = True
    while has_new:
        has_new = False
        for name in list(unbound):
            frame = _frame_on_points(frames[name], _anchors(name, shared, bound))
            if frame is not None:
                bound.frames[name] = frame
                unbound.remove(name)
                has_new = True
    for name in unbound:
        bound.lost[name] = f"no outputs give its pose; {BUILD_ALL}"


def _anchors(name: str, shared: Sequence[Shared], bound: Bound) -> list[tuple[Array, list[Any]]]:
    """Points of a frame, each with the coinciding point of a bound frame."""
    anchors = []
    for frame_a, point_a, frame_b, point_b in shared:
        for own_frame, own_point, other_frame, other_point in (
            (frame_a, point_a, frame_b, point_b),
            (frame_b, point_b, frame_a, point_a),
        ):
            if own_frame == name and (other_frame == GROUND or other_frame in bound.frames):
                anchor = [other_frame, [float(x) for x in np.array(other_point) + bound.moved.get(other_frame, 0.0)]]
                anchors.append((np.array(own_point, float), anchor))
    return anchors


def _frame_on_points(frame: Frame, anchors: Sequence[tuple[Array, list[Any]]]) -> Frame | None:
    """The frame on the three of its points that span the largest triangle."""
    largest: tuple[float, Sequence[tuple[Array, list[Any]]]] = (0.0, ())
    for triangle in combinations(anchors, 3):
        (a, _), (b, _), (c, _) = triangle
        area = float(np.linalg.norm(np.cross(b - a, c - a)))
        longest_side = max(float(np.linalg.norm(p - q)) for p, q in ((a, b), (b, c), (c, a)))
        if area > LEAST_HEIGHT * longest_side**2 and area > largest[0]:
            largest = area, triangle
    if not largest[1]:
        return None
    start = {"start": frame["start"]} if "start" in frame else {}
    return {
        "points": [[float(x) for x in p] for p, _ in largest[1]],
        "on": [anchor for _, anchor in largest[1]],
    } | start
