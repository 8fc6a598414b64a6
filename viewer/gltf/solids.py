"""Triangles of what a scene shows, as the code of the page makes them, and how they move."""

import base64
import json
import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ali3.errors import reason
from ali3.scene.base64_numbers import decoded
from ali3.scene.errors import ViewerError
from ali3.temporary_folder import temporary_folder
from viewer.bundle import SOLIDS, bundle
from viewer.gltf.materials import Look
from viewer.gltf.motion import Motion, least_twist
from viewer.page_build import node
from viewer.poses import FramePoses, Vectors, continuous

_BENT = 1e-3  # m: what changes its form more is told


@dataclass(frozen=True)
class Solid:
    """Triangles, counterclockwise as seen from outside."""

    positions: Vectors
    """m, shape (n, 3)."""
    normals: Vectors | None
    """Unit; None for flat triangles, shape (n, 3)."""
    triangles: NDArray[np.int64]
    """Numbers of positions, shape (m, 3)."""
    colors: Vectors | None = None
    """Linear, shape (n, 3)."""


Meshes = list[tuple[Solid, Look]]


@dataclass
class Parts:
    """Solids of a scene."""

    fixed: list[tuple[str, str, Meshes]]
    """What moves with a frame: the frame, a name, solids."""
    free: list[tuple[str, Motion, Meshes]]
    """What moves between frames, relative to the earth."""
    flexible: list[Solid]
    """The flexible parts at rest: 12 points around each end of each beam, then as many around each node."""
    things: dict[str, Solid]
    """The scenery by kind, in the axes of its world: x, y and up."""
    notes: list[str]
    """Sentences on what differs from the scene."""


def joined(solids: Sequence[Solid]) -> Solid:
    """Several solids without colours as one; flat if one of them is."""
    starts = np.cumsum([0, *(len(s.positions) for s in solids[:-1])])
    normals = [s.normals for s in solids if s.normals is not None]
    return Solid(
        np.vstack([s.positions for s in solids]),
        np.vstack(normals) if len(normals) == len(solids) else None,
        np.vstack([s.triangles + start for s, start in zip(solids, starts, strict=True)]),
    )


def parts_of(scene: Mapping[str, Any], poses: FramePoses, count: int) -> Parts:
    """What a scene shows over a run.

    `poses`: of its frames; `count`: of their times. Raises `ViewerError`: Node is not there, or fails.
    """
    names = list(scene["frames"])
    held = [poses.of(name) for name in names]
    numbers = np.array([np.hstack([pose.position, pose.quaternion]) for pose in held]).reshape(-1)
    kept = ("frames", "shapes", "flexible", "scenery", "meshes", "up", "focus")
    shown = {key: scene[key] for key in kept if key in scene}
    made = _answer({"scene": shown, "names": names, "count": count}, numbers)
    things = {kind: _solid(part) for kind, part in made["things"].items()}
    parts = Parts([], [], [_solid(part) for part in made["flexible"]], things, [])
    for shape, pieces in zip(scene["shapes"], made["shapes"], strict=True):
        name = shape.get("name") or shape.get("body") or shape["kind"]
        for piece in pieces:
            meshes = [(_solid(part), _look(part["look"])) for part in piece["parts"] if part["triangles"]]
            if not meshes:
                continue
            if "frame" in piece:
                parts.fixed.append((piece["frame"], name, meshes))
            else:
                parts.free.append((name, _motion(piece, count), meshes))
            if piece.get("bent", 0.0) > _BENT:
                parts.notes.append(
                    f"The {shape['kind']} {name!r} changes its form; it keeps that of the start, and a corner is off "
                    f"by {1000.0 * piece['bent']:.2g} mm at most."
                )
    return parts


def _motion(piece: Mapping[str, Any], count: int) -> Motion:
    position, quaternion, scale = (
        np.frombuffer(base64.b64decode(piece[path]), "<f8").reshape(count, -1)
        for path in ("position", "quaternion", "scale")
    )
    turned = continuous(quaternion[:, [3, 0, 1, 2]])
    return Motion(position, least_twist(turned) if piece["round"] else turned, scale)


def _look(values: dict[str, Any]) -> Look:
    coat = values["clearcoat"] and tuple(values["clearcoat"])
    return Look(**{**values, "color": tuple(values["color"]), "clearcoat": coat})


def _solid(part: Mapping[str, Any]) -> Solid:
    normals, colors = (
        None if part[name] is None else decoded(part[name], "f").astype(float).reshape(-1, 3)
        for name in ("normals", "colors")
    )
    positions = decoded(part["positions"], "f").reshape(-1, 3) + np.array(part["base"], dtype=float)
    return Solid(positions, normals, decoded(part["triangles"], "u").astype(np.int64).reshape(-1, 3), colors)


def _answer(question: Mapping[str, Any], numbers: Vectors) -> dict[str, Any]:
    """What the program of Node makes of a question."""
    try:
        command = [node()[0], str(bundle().with_name(SOLIDS))]
    except RuntimeError as error:
        raise ViewerError(f"A glTF file cannot be written. {error}") from None
    with temporary_folder() as folder:
        file = folder / "question"
        file.write_bytes(json.dumps(question).encode() + b"\n" + numbers.astype("<f8").tobytes())
        try:
            done = subprocess.run([*command, str(file)], capture_output=True, check=False)
        except OSError as error:
            raise ViewerError(f"A glTF file cannot be written: {command[0]} does not start: {reason(error)}.") from None
    if done.returncode != 0:
        why = " ".join(done.stderr.decode(errors="replace").split())[-400:]
        raise ViewerError(f"A glTF file cannot be written: the program that makes the triangles failed ({why}).")
    made: dict[str, Any] = json.loads(done.stdout)
    return made
