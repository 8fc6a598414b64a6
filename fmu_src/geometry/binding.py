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
FLATTEST = 1e-3  # height over side of a triangle whose plane fixes a frame
BUILD_ALL = "build the FMU with --poses all"


@dataclass(frozen=True)
class Bound:
    """Frames that variables move."""

    frames: dict[str, Frame]
    """As the scene has them."""
    moved: dict[str, Array]
    """Each of shape (3,): place of the drawing's origin in the frame, where it is not 0, m."""
    lost: dict[str, str]
    """Frames that nothing moves, and why."""
    amplitudes: dict[str, str]
    """Variables of amplitudes by the columns of the drawing."""


def bind(system: mbs.System, frames: Mapping[str, Frame], shared: Sequence[Shared]) -> Bound:
    """Find what moves the frames of a drawing. `shared`: points that frames share."""
    rows, bound = SensorRows(system), Bound({}, {}, {}, {})
    assert system.drawing is not None, "asked for before"
    places = {place.columns[0]: place for place in system.drawing.places.bodies}
    for name, frame in frames.items():
        if "position" in frame and frame["position"][0] in rows.names:
            bound.frames[name] = dict(frame)  # sensors place it in the model already
        elif "position" in frame:
            _by_columns(rows, name, frame, places[frame["position"][0]], bound)
    _by_points(frames, shared, bound)
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
    for place in system.drawing.places.amplitudes:
        for k, column in enumerate(place.columns):
            angle = rows.angle(place.row + k)
            if angle is not None:
                bound.amplitudes[column] = angle
    return bound


def _by_columns(rows: SensorRows, name: str, frame: Frame, place: BodyPlace, bound: Bound) -> None:
    """A body whose pose is output, at any of its points."""
    body = rows.body(place)
    turns = [names for names, axes in rows.quaternions() if body.axes is not None and np.allclose(axes, body.axes)]
    poses = []
    for names in rows.points():
        at = rows.place_of(names, body)
        if at is None:
            continue
        beside = tuple(f"{names[0][:-1]}q{c}" for c in "wxyz")
        if body.axes is None:
            poses += [(names, at, beside)] if rows.unturned(beside) else []
        elif turns:
            poses.append((names, at, beside if beside in turns else turns[0]))
    if not poses:
        return
    names, at, quaternion = next((f for f in poses if f[2][0] == f"{f[0][0][:-1]}qw"), poses[0])
    shift = -np.where(np.abs(at) < 1e-12, 0.0, at)
    if np.any(shift):
        bound.moved[name] = shift
    start = frame.get("start")
    bound.frames[name] = {"position": list(names), "quaternion": list(quaternion)} | (
        {} if start is None else {"start": [_shifted(start, -shift), start[1]]}
    )


def _shifted(start: Sequence[Sequence[float]], local: Array) -> list[float]:
    """Place of a local point of a start."""
    turned = matrices(np.array([start[1]]))[0] @ local
    return [float(x) + 0.0 for x in np.array(start[0]) + turned]


def _by_points(frames: Mapping[str, Frame], shared: Sequence[Shared], bound: Bound) -> None:
    """Bodies that share three points with frames that are moved, one after the other."""
    waiting = [name for name, frame in frames.items() if "position" in frame and name not in bound.frames]
    has_new = True
    while has_new:
        has_new = False
        for name in list(waiting):
            frame = _carried(frames[name], _anchors(name, shared, bound))
            if frame is not None:
                bound.frames[name] = frame
                waiting.remove(name)
                has_new = True
    for name in waiting:
        bound.lost[name] = f"no outputs give its pose; {BUILD_ALL}"


def _anchors(name: str, shared: Sequence[Shared], bound: Bound) -> list[tuple[Array, list[Any]]]:
    """Points of a frame, each with the point of a moved frame that it lies on."""
    anchors = []
    for one, place, other, there in shared:
        for mine, local, theirs, away in ((one, place, other, there), (other, there, one, place)):
            if mine == name and (theirs == GROUND or theirs in bound.frames):
                anchor = [theirs, [float(x) for x in np.array(away) + bound.moved.get(theirs, 0.0)]]
                anchors.append((np.array(local, float), anchor))
    return anchors


def _carried(frame: Frame, anchors: Sequence[tuple[Array, list[Any]]]) -> Frame | None:
    """The frame on the three of its points that span the largest triangle."""
    best: tuple[float, Sequence[tuple[Array, list[Any]]]] = (0.0, ())
    for three in combinations(anchors, 3):
        (a, _), (b, _), (c, _) = three
        area = float(np.linalg.norm(np.cross(b - a, c - a)))
        longest = max(float(np.linalg.norm(p - q)) for p, q in ((a, b), (b, c), (c, a)))
        if area > FLATTEST * longest**2 and area > best[0]:
            best = area, three
    if not best[1]:
        return None
    start = {"start": frame["start"]} if "start" in frame else {}
    return {"points": [[float(x) for x in p] for p, _ in best[1]], "on": [anchor for _, anchor in best[1]]} | start
