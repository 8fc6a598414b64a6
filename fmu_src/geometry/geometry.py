"""The scene of an FMU: the drawing of its System, with columns that are variables of the FMU."""

import json
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

import mbs
from ali3.scene.scene_columns import columns_of
from ali3.scene.scene_parts import frames_of
from fmu_src.geometry.binding import bind
from fmu_src.geometry.renamed_columns import with_renamed_columns
from fmu_src.geometry.roads import with_parameters
from fmu_src.geometry.sensor_rows import Array
from fmu_src.variables.variables import Variable, by_name_in_system

FRAME_TUBE = "frame tube"
"""Name of rigid shapes that stand for a flexible part; left out where that part is drawn deformed."""


def geometry(system: mbs.System, table: Sequence[Variable], name: str, description: str) -> dict[str, Any] | None:
    """The scene of an FMU; None if its System has no drawing. `system`: that of the default fidelity."""
    if system.drawing is None:
        return None
    scene = system.scene
    bound = bind(system, scene["frames"], system.drawing.shared)
    variables_by_name = by_name_in_system(table, system.meta)
    variable_names = set(variables_by_name)
    available_frames = {"ground", *bound.frames}

    def kept(parts: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
        return [moved_part(part, bound.moved) for part in parts if available_frames.issuperset(frames_of(part))]

    parts = [
        part | {"amplitudes": [bound.amplitudes.get(name, name) for name in part["amplitudes"]]}
        for part in kept(scene["flexible"])
    ]
    flexible_parts = [part for part in parts if set(part["amplitudes"]) <= variable_names]
    shapes = kept(scene["shapes"])
    if flexible_parts:
        shapes = [shape for shape in shapes if shape.get("name") != FRAME_TUBE]
    shapes += [tube for part in parts if part not in flexible_parts for tube in _stiff(part)]
    mesh_names = {shape["mesh"] for shape in shapes if shape["kind"] == "mesh"}
    shape_frames = {frame for shape in scene["shapes"] for frame in frames_of(shape)}
    fmu_scene = scene | {
        "name": name,
        "description": description,
        "frames": bound.frames,
        "shapes": shapes,
        "meshes": {key: mesh for key, mesh in scene["meshes"].items() if key in mesh_names},
        "flexible": flexible_parts,
        "arrows": [arrow for arrow in kept(scene["arrows"]) if variable_names.issuperset(columns_of(arrow))],
        "roads": with_parameters(scene["roads"], system, variable_names),
        "focus": scene["focus"] if scene["focus"] in bound.frames else "",
        "missing": [
            *scene["missing"],
            *({"name": frame, "why": why} for frame, why in bound.lost.items() if frame in shape_frames),
        ],
    }
    return with_renamed_columns(
        fmu_scene, {own: v for own, v in variables_by_name.items() if own != v.name or v.scale != 1.0}
    )


def _stiff(part: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Rigid tubes in place of a flexible part whose modal amplitudes are not outputs."""
    frame, nodes = part["frame"], part["nodes"]
    return [
        {"kind": "tube", "points": [[frame, nodes[i]], [frame, nodes[j]]], "radius": radius, "body": frame}
        for (i, j), radius in zip(part["beams"], part["radii"], strict=True)
    ]


def lost_frames(system: mbs.System) -> list[str]:
    """Frames of a System's drawing that carry shapes but that no output moves; none without a drawing."""
    if system.drawing is None:
        return []
    scene = system.drawing.scene
    lost = bind(system, scene["frames"], system.drawing.shared).lost
    shape_frames = {frame for part in (*scene["shapes"], *scene["flexible"]) for frame in frames_of(part)}
    return [frame for frame in lost if frame in shape_frames]


def geometry_file(scene: Mapping[str, Any]) -> bytes:
    """The scene of `geometry` as a file of the FMU, JSON."""
    return json.dumps(scene, ensure_ascii=False, allow_nan=False, separators=(",", ":")).encode()


def moved_part(part: Mapping[str, Any], moved: Mapping[str, Array]) -> dict[str, Any]:
    """A shape, arrow or flexible part in frames with other origins.

    `moved`, shape (3,): place of the old origin in the new frame, m, by frame.
    """
    shifted = dict(part)
    frame = part.get("frame")
    if frame is not None:
        shift = moved.get(frame)
        if shift is None:
            return shifted
        if part.get("kind") == "cylinder":
            shifted["ends"] = [_shifted_point(point, shift) for point in part["ends"]]
        elif "nodes" in part:
            shifted["nodes"] = [_shifted_point(point, shift) for point in part["nodes"]]
        else:
            shifted["at"] = _shifted_point(part.get("at", (0.0, 0.0, 0.0)), shift)
        return shifted
    for key in ("points", "ends", "between"):
        if key in part:
            shifted[key] = [_shifted_anchor(anchor, moved) for anchor in part[key]]
    if "vector" in part:
        shifted["at"] = _shifted_anchor(part["at"], moved)
    return shifted


def _shifted_anchor(anchor: Any, moved: Mapping[str, Array]) -> list[Any]:
    name, point = anchor
    return [name, _shifted_point(point, moved[name]) if name in moved else list(point)]


def _shifted_point(place: Any, shift: Array) -> list[float]:
    return [float(x) + 0.0 for x in np.asarray(place, float) + shift]
