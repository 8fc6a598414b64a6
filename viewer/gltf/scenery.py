"""Scenery of a world as triangles: paint, cones, posts, rails, signs, buildings, trees."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from viewer import solids
from viewer.gltf.materials import LOOKS, Look
from viewer.gltf.solids import Solid, joined
from viewer.poses import Vectors

THINGS = LOOKS["things"]
_LIFT = 0.012  # m of paint above the ground
_UPRIGHT = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])  # y of a solid upwards
_MOST_TREES = 1500
Parts = list[tuple[Solid, Sequence[float]]]


def scenery_solids(
    things: Sequence[Mapping[str, Any]], axes: Vectors, low: Vectors, high: Vectors
) -> tuple[dict[str, list[tuple[Solid, Look]]], int]:
    """What of a scenery stands in a rectangle, by kind.

    `things`: entries of the list `scenery` of a scene; `axes`: x, y and up of the world, one a row, shape (3, 3);
    `low`, `high`: x and y of the corners of the rectangle, m, shape (2,).

    Returns
    -------
    solids : dict of str to list of (Solid, Look)
        One solid a colour.
    left_out : int
        Things beyond the rectangle, and trees beyond 1500.
    """
    found: dict[str, dict[tuple[float, ...], list[Solid]]] = {}
    left_out = trees = 0
    for thing in things:
        points = np.array(thing.get("points") or [thing["at"]], float)[:, :2]
        trees += thing["kind"] == "tree"
        if (
            (points.max(axis=0) < low).any()
            or (points.min(axis=0) > high).any()
            or (thing["kind"] == "tree" and trees > _MOST_TREES)
        ):
            left_out += 1
            continue
        for solid, colour in _MAKERS[thing["kind"]](thing):
            found.setdefault(thing["kind"], {}).setdefault(tuple(colour), []).append(solid)
    turn = axes.T
    return {
        kind: [
            (solids.placed(joined(parts), turn), Look(kind, (colour[0], colour[1], colour[2], 1.0), 0.0, 0.85))
            for colour, parts in colours.items()
        ]
        for kind, colours in found.items()
    }, left_out


def ribbon(points: Vectors, width: float, up: Vectors, lift: float = _LIFT) -> Solid:
    """A flat band along points.

    `points`: of its middle, m, shape (n, 3); no two that follow each other are the same; `width`, `lift`: in m; lift:
    above the points; `up`: unit, shape (3,).
    """
    way = np.gradient(points, axis=0)
    side = np.cross(up, way)
    side /= np.maximum(np.linalg.norm(side, axis=1), 1e-12)[:, None]
    edges = np.stack([points - 0.5 * width * side, points + 0.5 * width * side], axis=1) + lift * up
    a = 2 * np.arange(len(points) - 1)
    triangles = np.vstack([np.column_stack([a, a + 2, a + 1]), np.column_stack([a + 1, a + 2, a + 3])])
    return Solid(edges.reshape(-1, 3), np.tile(up, (2 * len(points), 1)), triangles)


def _box(at: Sequence[float] | Vectors, size: Sequence[float], yaw: float) -> Solid:
    """A box that stands at a place."""
    c, s = math.cos(yaw), math.sin(yaw)
    middle = np.add(at, (0.0, 0.0, 0.5 * size[2]))
    return solids.placed(solids.box(size), np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]), middle)


def _turned(at: Sequence[float], profile: Sequence[tuple[float, float]], sections: int) -> Solid:
    return solids.placed(solids.lathe(profile, sections), _UPRIGHT, at)


def _line(thing: Mapping[str, Any]) -> Parts:
    points = np.array(thing["points"], float)
    points = points[np.r_[True, np.linalg.norm(np.diff(points, axis=0), axis=1) > 1e-6]]
    colour = LOOKS["paints"][thing.get("colour", "white")]
    up = np.array([0.0, 0.0, 1.0])
    return [(ribbon(part, thing["width"], up), colour) for part in _dashes(points, thing.get("dash")) if len(part) > 1]


def _dashes(points: Vectors, dash: Sequence[float] | None) -> Iterable[Vectors]:
    """Stretches of a line that are painted."""
    if dash is None:
        yield points
        return
    way = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points[:, :2], axis=0), axis=1))]
    for begin in np.arange(0.0, way[-1] - 1e-6, dash[0] + dash[1]):
        end = min(begin + dash[0], way[-1])
        stations = np.r_[begin, way[(way > begin + 1e-6) & (way < end - 1e-6)], end]
        yield np.column_stack([np.interp(stations, way, points[:, k]) for k in range(3)])


def _cone(thing: Mapping[str, Any]) -> Parts:
    height, at = thing.get("height", 0.5), thing["at"]
    colour = THINGS["cones"][thing.get("colour", "orange")]
    foot = _box(at, (0.56 * height, 0.56 * height, 0.05 * height), 0.0)
    levels = (0.05, 0.38, 0.58, 0.72, 0.86, 1.0)
    made: Parts = [(foot, [0.6 * value for value in colour])]
    for k, (a, b) in enumerate(pairwise(levels)):
        ring = [(height * (0.21 - 0.165 * z), height * z) for z in (a, b)]
        ring += [(0.0, height * b)] if b == 1.0 else []
        made.append((_turned(at, ring, 12), THINGS["white"] if k % 2 else colour))
    return made


def _post(thing: Mapping[str, Any]) -> Parts:
    height, (x, y, z) = thing.get("height", 1.0), thing["at"]
    parts = ((0.0, 0.72, THINGS["white"]), (0.72, 0.2, LOOKS["paints"]["black"]), (0.92, 0.08, THINGS["white"]))
    return [(_box((x, y, z + low * height), (0.1, 0.12, high * height), 0.0), colour) for low, high, colour in parts]


def _barrier(thing: Mapping[str, Any]) -> Parts:
    points, height = np.array(thing["points"], float), thing.get("height", 0.8)
    made = []
    for a, b in pairwise(points):
        length = float(np.hypot(*(b - a)[:2]))
        if length > 0.0:
            yaw, middle = math.atan2(b[1] - a[1], b[0] - a[0]), 0.5 * (a + b) + (0.0, 0.0, 0.6 * height)
            made.append((_box(middle, (length, 0.12, 0.4 * height), yaw), THINGS["zinc"]))
            made.append((_box(a, (0.1, 0.1, 0.94 * height), yaw), THINGS["zinc"]))
    return made


def _sign(thing: Mapping[str, Any]) -> Parts:
    height, at, yaw = thing.get("height", 2.5), thing["at"], thing["yaw"]
    share = min(1.0, height / 1.3)
    wide, high = 1.8 * share, 0.9 * share
    made: Parts = [(_box(np.add(at, (0.0, 0.0, height - high)), (0.04, wide, high), yaw), THINGS["board"])]
    for aside in (-0.35 * wide, 0.35 * wide):
        foot = np.add(at, (-aside * math.sin(yaw), aside * math.cos(yaw), 0.0))
        made.append((_box(foot, (0.06, 0.06, height), yaw), THINGS["zinc"]))
    return made


def _building(thing: Mapping[str, Any]) -> Parts:
    length, width, height = thing["size"]
    at, yaw = np.array(thing["at"], float), thing["yaw"]
    eaves = height / (1.0 + (0.22 * min(width, 12.0)) / height)
    c, s = math.cos(yaw), math.sin(yaw)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    l, w = 0.5 * length + 0.3, 0.5 * width + 0.4
    corners = np.array([[a * l, b * w, eaves] for a in (-1, 1) for b in (-1, 1)] + [[-l, 0, height], [l, 0, height]])
    faces = [[0, 2, 5], [0, 5, 4], [3, 1, 4], [3, 4, 5], [1, 0, 4], [2, 3, 5], [0, 1, 3], [0, 3, 2]]
    flat = corners[np.array(faces)]
    normals = np.cross(flat[:, 1] - flat[:, 0], flat[:, 2] - flat[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    roof = Solid(flat.reshape(-1, 3), np.repeat(normals, 3, axis=0), np.arange(3 * len(faces)).reshape(-1, 3))
    walls = _box(at - (0.0, 0.0, 0.5), (length, width, eaves + 0.5), yaw)
    return [(walls, THINGS["wall"]), (solids.placed(roof, turn, at), THINGS["roof"])]


def _tree(thing: Mapping[str, Any]) -> Parts:
    """Trunk and crown; the page has twigs."""
    height, at = thing["height"], thing["at"]
    trunk = [(0.028 * height, -0.01 * height), (0.014 * height, 0.5 * height)]
    crown = [(0.0, 0.22), (0.2, 0.34), (0.24, 0.55), (0.14, 0.83), (0.0, 1.0)]
    return [
        (_turned(at, trunk, 5), THINGS["bark"]),
        (_turned(at, [(r * height, z * height) for r, z in crown], 7), THINGS["leaves"]),
    ]


def _arrow(thing: Mapping[str, Any]) -> Parts:
    length, yaw = thing.get("length", 4.0), thing["yaw"]
    outline = np.array(
        [[-0.5, -0.035], [0.1, -0.035], [0.1, 0.035], [-0.5, 0.035], [0.1, -0.14], [0.5, 0.0], [0.1, 0.14]]
    )
    c, s = math.cos(yaw), math.sin(yaw)
    flat = length * outline @ np.array([[c, s], [-s, c]])
    points = np.column_stack([flat, np.full(len(flat), _LIFT)]) + thing["at"]
    triangles = np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6]])
    return [(Solid(points, np.tile([0.0, 0.0, 1.0], (len(points), 1)), triangles), LOOKS["paints"]["white"])]


_MAKERS: dict[str, Callable[[Mapping[str, Any]], Parts]] = {
    "line": _line,
    "cone": _cone,
    "post": _post,
    "barrier": _barrier,
    "sign": _sign,
    "building": _building,
    "tree": _tree,
    "arrow": _arrow,
}
