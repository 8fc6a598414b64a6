"""From the drawing of a System to the scene of its FMU."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

import mbs
from fmu_src.geometry.binding import bind
from fmu_src.geometry.moved_places import moved_part
from fmu_src.geometry.roads import with_parameters
from fmu_src.variables import Variable
from mbs.shapes.scene import frames_used

PATH = "resources/geometry.json"
FRAME_TUBE = "frame tube"
"""Name of shapes that a flexible part draws too."""


def geometry(
    system: mbs.System,
    table: Sequence[Variable],
    name: str,
    description: str,
    flexible: Sequence[Mapping[str, Any]] = (),
) -> dict[str, Any] | None:
    """The scene of an FMU: its columns are variables of the FMU.

    Parameters
    ----------
    system : mbs.System
        The default one.
    table : sequence of Variable
        Of the FMU.
    name, description : str
        Of the model.
    flexible : sequence of mapping
        Flexible parts whose amplitudes are outputs, in place of those of the drawing.

    Returns
    -------
    dict or None
        None where the System carries no drawing.
    """
    if system.drawing is None:
        return None
    scene = system.scene
    bound = bind(system, scene["frames"], system.drawing.shared)
    known = {v.name for v in table}
    here = {"ground", *bound.frames}

    def kept(parts: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
        return [moved_part(part, bound.moved) for part in parts if frames_used(part) <= here]

    parts = [part for part in flexible if part["frame"] in here]
    if not parts:
        parts = [p for p in kept(scene["flexible"]) if set(p["amplitudes"]) <= known]
    shapes = kept(scene["shapes"])
    if parts:
        shapes = [shape for shape in shapes if shape.get("name") != FRAME_TUBE]
    used = {shape["mesh"] for shape in shapes if shape["kind"] == "mesh"}
    drawn = {frame for shape in scene["shapes"] for frame in frames_used(shape)}
    return scene | {
        "name": name,
        "description": description,
        "frames": bound.frames,
        "shapes": shapes,
        "meshes": {key: mesh for key, mesh in scene["meshes"].items() if key in used},
        "flexible": parts,
        "arrows": [arrow for arrow in kept(scene["arrows"]) if set(_columns(arrow)) <= known],
        "roads": with_parameters(scene["roads"], system, known),
        "focus": scene["focus"] if scene["focus"] in bound.frames else "",
        "missing": [
            *scene["missing"],
            *({"name": frame, "why": why} for frame, why in bound.lost.items() if frame in drawn),
        ],
    }


def _columns(arrow: Mapping[str, Any]) -> list[str]:
    """Names of the variables of an arrow."""
    if "tyre" in arrow:
        return [name for names in arrow["tyre"].values() for name in names]
    return [arrow["value"]] if "value" in arrow else [name for name in arrow["vector"] if name is not None]


def geometry_file(scene: Mapping[str, Any]) -> bytes:
    """The scene as it lies in the FMU.

    Parameters
    ----------
    scene : mapping
        From `geometry`.
    """
    return json.dumps(scene, ensure_ascii=False, allow_nan=False, separators=(",", ":")).encode()
