"""Checks relations between entries of a scene: names of frames and meshes, lengths of arrays, orthonormal axes.

They follow the check of types; each fault is a sentence.
"""

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from ali3.columns import some_of
from ali3.message_text import value_text
from ali3.scene.base64_numbers import decoded, octets
from ali3.scene.scene_parts import GROUND, anchors_of, frames_of
from ali3.scene.scene_sentences import place

_AXES_TOLERANCE = 1e-3  # largest deviation of the axes of a shape from orthonormal ones


@np.errstate(over="ignore", invalid="ignore")  # products of numbers above 1e154 fail the checks too
def relation_errors(scene: Mapping[str, Any]) -> list[str]:
    """Sentences on faulty relations in a scene whose entries have the right types."""
    errors = list(_frame_errors(scene))
    for k, shape in enumerate(scene["shapes"]):
        errors += _shape_errors(scene, shape, ("shapes", k))
    for name, mesh in (scene.get("meshes") or {}).items():
        errors += _mesh_errors(mesh, ("meshes", name))
    for k, part in enumerate(scene.get("flexible") or []):
        errors += _flexible_errors(scene, part, ("flexible", k))
    for k, arrow in enumerate(scene.get("arrows") or []):
        errors += _attachment_errors(scene, arrow, ("arrows", k))
    for k, road in enumerate(scene.get("roads") or []):
        errors += _road_errors(road, ("roads", k))
    if not any(scene.get("up") or (0.0, 0.0, 1.0)):
        errors.append("up is [0, 0, 0]; it must have a direction.")
    if scene.get("focus") and scene["focus"] not in _frame_names(scene):
        errors.append(_unknown_frame(scene, ("focus",), scene["focus"]))
    return errors


def _frame_names(scene: Mapping[str, Any]) -> list[str]:
    return [GROUND, *scene["frames"]]


def _unknown_frame(scene: Mapping[str, Any], path: tuple[str | int, ...], name: str) -> str:
    frames = some_of(map(repr, _frame_names(scene)), 8)
    return f"{place(path)} is {value_text(name)}, which is not a frame; there are {frames}."


def _frame_errors(scene: Mapping[str, Any]) -> Iterator[str]:
    frames = _frame_names(scene)
    frames_exist = True
    for name, frame in scene["frames"].items():
        path = ("frames", name)
        if name == GROUND:
            yield f"{place(path)} is given; the frame 'ground' is there always: earth axes."
        for needed_frame in frames_of(frame):
            if needed_frame not in frames:
                frames_exist = False
                yield _unknown_frame(scene, (*path, "parent" if "parent" in frame else "on"), needed_frame)
        for key in ("axis", "direction"):
            if key in frame:
                yield from _direction_errors(frame[key], (*path, key))
        if isinstance(frame.get("start"), (list, tuple)):
            yield from _direction_errors(frame["start"][1], (*path, "start", 1))
        if "points" in frame:
            a, b, c = (np.array(p, float) for p in frame["points"])
            least_area = 1e-9 * np.maximum(np.linalg.norm(b - a), 1e-12) ** 2
            if not least_area < np.linalg.norm(np.cross(b - a, c - a)):
                yield f"{place((*path, 'points'))} lie on a line; three points of a plane are needed."
    if frames_exist:
        yield from _cycle_errors(scene)


def _cycle_errors(scene: Mapping[str, Any]) -> Iterator[str]:
    resolved = {GROUND}
    remaining = dict(scene["frames"])
    while remaining:
        ready = [name for name, frame in remaining.items() if resolved.issuperset(frames_of(frame))]
        if not ready:
            yield f"{place(('frames', next(iter(remaining))))} depends on itself through other frames."
            return
        resolved.update(ready)
        for name in ready:
            del remaining[name]


def _length_errors(count: int, expected: int, path: tuple[str | int, ...], each: str) -> Iterator[str]:
    if count != expected:
        yield f"{place(path)} has {count} entries; it must have {expected}, one for each {each}."


def _direction_errors(vector: Any, path: tuple[str | int, ...]) -> Iterator[str]:
    if not math.hypot(*vector) > 0.0:
        yield f"{place(path)} is {value_text(vector)}; it must not be zero."


def _attachment_errors(scene: Mapping[str, Any], part: Mapping[str, Any], path: tuple[str | int, ...]) -> Iterator[str]:
    frames = _frame_names(scene)
    for key in ("frame", "axes"):
        if isinstance(part.get(key), str) and part[key] not in frames:
            yield _unknown_frame(scene, (*path, key), part[key])
    key = next((k for k in ("points", "ends", "between") if k in part), "at")
    for k, anchor in enumerate(anchors_of(part)):
        if anchor[0] not in frames:
            yield _unknown_frame(scene, (*path, key, 0) if key == "at" else (*path, key, k, 0), anchor[0])


def _shape_errors(scene: Mapping[str, Any], shape: Mapping[str, Any], path: tuple[str | int, ...]) -> Iterator[str]:
    yield from _attachment_errors(scene, shape, path)
    if shape["kind"] == "mesh" and shape["mesh"] not in (scene.get("meshes") or {}):
        names = ", ".join(map(repr, scene.get("meshes") or {})) or "none"
        yield f"{place((*path, 'mesh'))} is {value_text(shape['mesh'])}, which is not a mesh; there are {names}."
    if shape.get("axes") is not None:
        axes = np.array(shape["axes"], float)
        if not np.abs(axes @ axes.T - np.eye(3)).max() <= _AXES_TOLERANCE or np.linalg.det(axes) < 0.0:
            yield f"{place((*path, 'axes'))} must be three unit vectors at right angles, right-handed."
    if shape["kind"] in ("wheel", "steering_wheel") and shape.get("axis") is not None:
        yield from _direction_errors(shape["axis"], (*path, "axis"))
    if shape["kind"] == "cylinder" and list(shape["ends"][0]) == list(shape["ends"][1]):
        yield f"{place((*path, 'ends'))} are one point; a cylinder has a length."
    if shape.get("rim") is not None and shape["rim"] >= shape["radius"]:
        yield f"{place((*path, 'rim'))} is {shape['rim']:g}; it must be below the radius, {shape['radius']:g}."


def _array_errors(text: str, kind: str, path: tuple[str | int, ...], size: int | None = None) -> Iterator[str]:
    try:
        numbers = decoded(text, kind)
    except ValueError as error:
        yield f"{place(path)} {error}."
        return
    if size is not None and len(numbers) != size:
        yield f"{place(path)} has {len(numbers)} numbers; it must have {size}."
    elif kind == "f" and not np.isfinite(numbers).all():
        yield f"{place(path)} holds {int((~np.isfinite(numbers)).sum())} values that are not numbers."


def _mesh_errors(mesh: Mapping[str, Any], path: tuple[str | int, ...]) -> Iterator[str]:
    faults = [
        *_array_errors(mesh["positions"], "f", (*path, "positions")),
        *_array_errors(mesh["triangles"], "u", (*path, "triangles")),
    ]
    yield from faults
    if faults:
        return
    positions, corners = decoded(mesh["positions"], "f"), decoded(mesh["triangles"], "u")
    if mesh.get("normals") is not None:
        yield from _array_errors(mesh["normals"], "f", (*path, "normals"), len(positions))
    for key, numbers in (("positions", positions), ("triangles", corners)):
        if len(numbers) == 0 or len(numbers) % 3:
            yield f"{place((*path, key))} has {len(numbers)} numbers; it must be three a point, and not none."
            return
    if corners.max() >= len(positions) // 3:
        yield f"{place((*path, 'triangles'))} names corner {corners.max()}; the largest is {len(positions) // 3 - 1}."


def _flexible_errors(scene: Mapping[str, Any], part: Mapping[str, Any], path: tuple[str | int, ...]) -> Iterator[str]:
    yield from _attachment_errors(scene, part, path)
    nodes, beams, modes = len(part["nodes"]), len(part["beams"]), len(part["amplitudes"])
    for key, count, each in (("names", nodes, "node"), ("start", modes, "mode")):
        if part.get(key) is not None:
            yield from _length_errors(len(part[key]), count, (*path, key), each)
    yield from _array_errors(part["modes"], "f", (*path, "modes"), nodes * 3 * modes)
    yield from _length_errors(len(part["radii"]), beams, (*path, "radii"), "beam")
    for k, beam in enumerate(part["beams"]):
        if max(beam) >= nodes:
            yield f"{place((*path, 'beams', k))} names node {max(beam)}; the largest is {nodes - 1}."
    for k, gauge in enumerate(part.get("gauges") or []):
        if max(gauge["nodes"]) >= nodes:
            location = place((*path, "gauges", k, "nodes"))
            yield f"{location} names node {max(gauge['nodes'])}; the largest is {nodes - 1}."
    stress = part.get("stress")
    if stress is not None:
        if stress.get("rule") == "round" and stress["fibres"] != 3:
            yield f"{place((*path, 'stress', 'fibres'))} is {stress['fibres']}; the rule 'round' has 3."
        count = beams * 2 * stress["fibres"]
        yield from _array_errors(stress["rows"], "f", (*path, "stress", "rows"), count * modes)
        if stress.get("constant") is not None:
            yield from _array_errors(stress["constant"], "f", (*path, "stress", "constant"), count)


def _road_errors(road: Mapping[str, Any], path: tuple[str | int, ...]) -> Iterator[str]:
    for key in ("normal", "direction"):
        if key in road:
            yield from _direction_errors(road[key], (*path, key))
    if road["kind"] == "profile":
        stations, heights = road["stations"], road["heights"]
        yield from _length_errors(len(heights), len(stations), (*path, "heights"), "station")
        if not (np.diff(stations) > 0.0).all():
            yield f"{place((*path, 'stations'))} must rise."
    if road["kind"] == "terrain":
        yield from _terrain_errors(road, path)
    if road["kind"] == "grid":
        size = road["shape"][0] * road["shape"][1]
        yield from _array_errors(road["heights"], "f", (*path, "heights"), size)
        if road.get("frictions") is not None:
            yield from _array_errors(road["frictions"], "f", (*path, "frictions"), size)


def _terrain_errors(road: Mapping[str, Any], path: tuple[str | int, ...]) -> Iterator[str]:
    for k, patch in enumerate(road["patches"]):
        size = patch["shape"][0] * patch["shape"][1]
        yield from _array_errors(patch["heights"], "f", (*path, "patches", k, "heights"), size)
    surface, prefix = road["surface"], (*path, "surface")
    yield from _length_errors(len(surface["frictions"]), len(surface["names"]), (*prefix, "frictions"), "name")
    try:
        cells = octets(surface["classes"])
    except ValueError as error:
        yield f"{place((*prefix, 'classes'))} {error}."
        return
    size = surface["shape"][0] * surface["shape"][1]
    if len(cells) != size:
        yield f"{place((*prefix, 'classes'))} has {len(cells)} numbers; it must have {size}."
    elif cells.max() >= len(surface["names"]):
        yield f"{place((*prefix, 'classes'))} names surface {cells.max()}; the largest is {len(surface['names']) - 1}."
