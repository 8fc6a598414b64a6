"""Roads of a scene as triangles."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ali3.scene.base64_numbers import decoded
from viewer.gltf.materials import LOOKS
from viewer.gltf.solids import Solid
from viewer.poses import Vectors

_MOST = 200  # points of a grid in each direction
_KINDS = ("ice", "wet", "asphalt")
_SLIPPERY = (0.35, 0.725)  # friction up to which a road is ice, and wet: half of the way between them, as pages have it


def road_solid(road: Mapping[str, Any], up: Vectors, centre: Vectors, half: float) -> tuple[Solid, int] | None:
    """Triangles of a road, and of how many points in a row one is drawn; None for one that stands in a file.

    `up`: unit, shape (3,); `centre`: of the motion, shape (3,): roads without an end are drawn about it; `half`: half
    the side of what is drawn of them, m.
    """
    kind = road["kind"]
    if kind == "flat":
        return _square(float(road.get("height", 0.0)) * up, up, centre, half), 1
    if kind == "plane":
        normal = np.asarray(road.get("normal") or up, dtype=float)
        point = np.asarray(road.get("point") or (0.0, 0.0, 0.0), dtype=float)
        return _square(point, normal / np.linalg.norm(normal), centre, half), 1
    if kind == "profile":
        return _profile(road, up, centre, half), 1
    return _grid(road, up) if kind == "grid" else None


def surfaces_of(road: Mapping[str, Any], solid: Solid) -> dict[str, Solid]:
    """The triangles of a road by what its friction, or those of a grid, make of them; dry ones are asphalt."""
    factor = road.get("friction_factor", 1.0)
    if road["kind"] != "grid" or road.get("frictions") is None:
        friction = road.get("friction")
        return {_KINDS[int(np.digitize(factor * (LOOKS["dry"] if friction is None else friction), _SLIPPERY))]: solid}
    frictions = decoded(road["frictions"], "f").reshape(road["shape"])[np.ix_(*_kept(*road["shape"])[1])].ravel()
    kinds = np.digitize(factor * frictions[solid.triangles].mean(axis=1), _SLIPPERY)
    made = {}
    for kind in np.unique(kinds):
        used, numbers = np.unique(solid.triangles[kinds == kind], return_inverse=True)
        made[_KINDS[kind]] = Solid(solid.positions[used], None, numbers.reshape(-1, 3))
    return made


def _kept(nx: int, ny: int) -> tuple[int, list[NDArray[np.int64]]]:
    """Every how many points of a grid one is drawn, and which, along x, where its border goes on, and y."""
    every = max(1, -(-max(nx, ny) // _MOST))
    i, j = (np.unique([*range(0, n, every), n - 1]) for n in (nx, ny))
    return every, [np.array([0, *i, nx - 1]), j]


def _square(point: Vectors, normal: Vectors, centre: Vectors, half: float) -> Solid:
    middle = centre - normal * float(normal @ (centre - point))
    x = np.cross(np.eye(3)[int(np.argmin(np.abs(normal)))], normal)
    x /= np.linalg.norm(x)
    y = np.cross(normal, x)
    corners = np.array([middle + half * (a * x + b * y) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
    return Solid(corners, np.tile(normal, (4, 1)), np.array([[0, 1, 2], [0, 2, 3]]))


def _profile(road: Mapping[str, Any], up: Vectors, centre: Vectors, half: float) -> Solid:
    """Heights along a direction, level before and behind."""
    forward = np.asarray(road.get("direction") or (1.0, 0.0, 0.0), dtype=float)
    forward = forward / np.linalg.norm(forward)
    origin = np.asarray(road.get("origin") or (0.0, 0.0, 0.0), dtype=float)
    side = np.cross(up, forward)
    stations, heights = np.asarray(road["stations"], dtype=float), np.asarray(road["heights"], dtype=float)
    here = float(forward @ (centre - origin))
    near = np.abs(stations - here) < half  # a kerb may be far away
    ends = np.array([here - half, here + half])
    beside = np.interp(ends, stations, heights)
    stations = np.array([ends[0], *stations[near], ends[1]])
    heights = np.array([beside[0], *heights[near], beside[1]])
    wide = 0.5 * float(road["width"]) if road.get("width") else half
    line = origin + stations[:, None] * forward + heights[:, None] * up
    points = np.stack([line - wide * side, line + wide * side], axis=1).reshape(-1, 3)
    a = 2 * np.flatnonzero(np.hypot(np.diff(stations), np.diff(heights)) > 0.0)
    return Solid(points, None, np.vstack([np.column_stack([a, a + 2, a + 3]), np.column_stack([a, a + 3, a + 1])]))


def _grid(road: Mapping[str, Any], up: Vectors) -> tuple[Solid, int]:
    nx, ny = road["shape"]
    heights = decoded(road["heights"], "f").reshape(nx, ny).astype(float)
    every, (i, j) = _kept(nx, ny)
    x = road["origin"][0] + road["spacing"][0] * i
    x[[0, -1]] += -LOOKS["border"], LOOKS["border"]
    y = road["origin"][1] + road["spacing"][1] * j
    axes = np.array(
        road.get("axes") or ([[1, 0, 0], [0, 1, 0]] if abs(up[2]) > 0.5 else [[1, 0, 0], [0, 0, -1]]), float
    )
    across = x[:, None, None] * axes[0] + y[None, :, None] * axes[1]
    points = (across + heights[np.ix_(i, j)][:, :, None] * up).reshape(-1, 3)
    a = (np.arange(len(i) - 1)[:, None] * len(j) + np.arange(len(j) - 1)).ravel()
    b = a + len(j)
    return Solid(points, None, np.vstack([np.column_stack([a, b, b + 1]), np.column_stack([a, b + 1, a + 1])])), every
