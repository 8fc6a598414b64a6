"""The paths of the reference point and of the wheels as bands on the ground."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from viewer.gltf.materials import LOOKS, Look, linear
from viewer.gltf.solids import Solid, joined
from viewer.poses import FramePoses, Vectors

PATHS = LOOKS["paths"]
_MOST = 4000  # points
_LIFT = 0.05  # m: tyres are not as round as they are taken to be, but pressed in


def path_solids(
    scene: Mapping[str, Any], poses: FramePoses, up: Vectors, epoch: NDArray[np.float64]
) -> list[tuple[str, Solid, Look]]:
    """Bands where a run has been; none where what is followed stays where it is.

    `poses`: of its frames, over the run; `up`: unit, shape (3,); `epoch`: shape (n,); no band goes from one to another.
    """
    focus = scene.get("focus")
    if not focus or scene.get("planar"):
        return []
    body = poses.of(focus)
    shown = body.shown
    if not shown.any():
        return []
    wheels = [shape for shape in scene["shapes"] if shape["kind"] == "wheel"]
    feet = [poses.of(wheel["frame"]).position - wheel["radius"] * up for wheel in wheels]
    if feet:
        ground = np.mean([foot @ up for foot in feet], axis=0)
    else:
        ground = np.full(len(shown), (body.position[shown] @ up).min())
    middle = body.position + (ground - body.position @ up)[:, None] * up
    if np.linalg.norm(middle[shown] - middle[shown][0], axis=1).max() < scene["extent"]:
        return []
    names = ["path", *(f"path {wheel['frame']}" for wheel in wheels)]
    colours = [linear(PATHS["body"]), *([linear(PATHS["wheel"])] * len(wheels))]
    motions = [part for part in (shown & (epoch == one) for one in np.unique(epoch)) if part.any()]
    made = []
    for k, (name, points, colour) in enumerate(zip(names, [middle, *feet], colours, strict=True)):
        share, opacity = (PATHS[key][min(k, 1)] for key in ("shares", "opacities"))
        ways = [_apart(points[part], 0.02 * scene["extent"]) for part in motions]
        bands = [_ribbon(way, share * scene["extent"], up) for way in ways if len(way) > 1]
        if bands:
            made.append((name, joined(bands), Look("path", (*colour, opacity), 0.0, 1.0, double=True)))
    return made


def _apart(points: Vectors, least: float) -> Vectors:
    """Points that are so far from each other, at most 4000 of them."""
    way = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    stations = np.floor(way / max(least, way[-1] / _MOST))
    return points[np.r_[True, np.diff(stations) > 0]]


def _ribbon(points: Vectors, width: float, up: Vectors) -> Solid:
    """A flat band along points, of which no two that follow each other are the same."""
    side = np.cross(up, np.gradient(points, axis=0))
    side /= np.maximum(np.linalg.norm(side, axis=1), 1e-12)[:, None]
    edges = np.stack([points - 0.5 * width * side, points + 0.5 * width * side], axis=1) + _LIFT * up
    a = 2 * np.arange(len(points) - 1)
    triangles = np.vstack([np.column_stack([a, a + 2, a + 1]), np.column_stack([a + 1, a + 2, a + 3])])
    return Solid(edges.reshape(-1, 3), np.tile(up, (2 * len(points), 1)), triangles)
