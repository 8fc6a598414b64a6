"""What a scene shows: solids that stand in frames, and solids that move between them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ali3.scene.base64_numbers import decoded
from viewer import solids
from viewer.composed import SHAPES, composed
from viewer.gltf.materials import Look, look
from viewer.gltf.motion import Motion, between
from viewer.poses import GROUND, FramePoses, Vectors, axes_of_points, conjugate, from_matrices, held, rotated
from viewer.solids import Solid, along, joined

Meshes = list[tuple[Solid, Look]]

_CONSTANT = 1e-5  # of a length: what does not change more is rigid
_RINGS = 6  # of the balls at the ends of tubes, of which a car has hundreds


@dataclass
class Parts:
    """Solids of a scene."""

    poses: FramePoses
    scene: Mapping[str, Any]
    fixed: list[tuple[str, str, Meshes]] = field(default_factory=list)
    """What moves with a frame."""
    free: list[tuple[str, Motion, Meshes]] = field(default_factory=list)
    """What moves between frames, relative to the earth."""
    notes: list[str] = field(default_factory=list)
    """Sentences on what differs from the scene."""

    def add(self, shape: Mapping[str, Any]) -> None:
        """Add a shape of the scene."""
        name = shape.get("name") or shape.get("body") or shape["kind"]
        _MAKERS[shape["kind"]](self, shape, name)


def _axes(shape: Mapping[str, Any]) -> Vectors:
    return np.array(shape["axes"], dtype=float).T if shape.get("axes") else np.eye(3)


def _at(shape: Mapping[str, Any]) -> Sequence[float]:
    return shape.get("at") or (0.0, 0.0, 0.0)


def _box(parts: Parts, shape: Mapping[str, Any], name: str) -> None:
    made = solids.box(shape["size"]).placed(_axes(shape), _at(shape))
    parts.fixed.append((shape["frame"], name, [(made, look(shape))]))


def _sphere(parts: Parts, shape: Mapping[str, Any], name: str) -> None:
    made = solids.sphere(shape["radius"]).placed(np.eye(3), _at(shape))
    parts.fixed.append((shape["frame"], name, [(made, look(shape))]))


def _cylinder(parts: Parts, shape: Mapping[str, Any], name: str) -> None:
    made = _rod(np.array(shape["ends"], dtype=float), shape["radius"])
    parts.fixed.append((shape["frame"], name, [(made, look(shape))]))


def _mesh(parts: Parts, shape: Mapping[str, Any], name: str) -> None:
    mesh = parts.scene["meshes"][shape["mesh"]]
    positions = decoded(mesh["positions"], "f").reshape(-1, 3).astype(float)
    triangles = decoded(mesh["triangles"], "u").reshape(-1, 3).astype(np.int64)
    normals = None
    if mesh.get("normals"):
        normals = decoded(mesh["normals"], "f").reshape(-1, 3).astype(float)
        length = np.linalg.norm(normals, axis=1)[:, None]
        normals = normals / length if (length > 0.0).all() else None
    a, b, c = triangles.T
    proper = triangles[(a != b) & (b != c) & (c != a)]
    if _volume(positions, proper) < 0.0:  # inside out
        proper = proper[:, ::-1]
    if len(proper):
        made = Solid(positions, normals, proper).placed(_axes(shape), _at(shape))
        parts.fixed.append((shape["frame"], name, [(made, look(shape, double=True))]))


def _tube(parts: Parts, shape: Mapping[str, Any], name: str) -> None:
    points, radius = shape["points"], shape["radius"]
    surface = look(shape, "steel")
    frame = points[0][0]
    if all(anchor[0] == frame for anchor in points):
        local = np.array([anchor[1] for anchor in points], dtype=float)
        rods = [
            _rod(local[i : i + 2], radius, 2 * _RINGS)
            for i in range(len(local) - 1)
            if (local[i] != local[i + 1]).any()
        ]
        made = joined([*rods, *(solids.sphere(radius, _RINGS).placed(np.eye(3), p) for p in local)])
        parts.fixed.append((frame, name, [(made, surface)]))
        return
    for k in range(len(points) - 1):
        a, b = (parts.poses.points(anchor) for anchor in points[k : k + 2])
        _link(parts, name, a, b, surface, lambda length: solids.cylinder(radius, 0.0, length, 2 * _RINGS))
    for anchor in points:
        _ball(parts, anchor, radius, name, surface)


def _plate(parts: Parts, shape: Mapping[str, Any], name: str) -> None:
    points, thickness = shape["points"], shape["thickness"]
    surface = look(shape, "steel", double=True)
    frame = points[0][0]
    if all(anchor[0] == frame for anchor in points):
        made = solids.plate(np.array([anchor[1] for anchor in points], dtype=float), thickness)
        parts.fixed.append((frame, name, [(made, surface)]))
        return
    earth = np.stack([parts.poses.points(anchor) for anchor in points], axis=1)
    pose = held(earth[:, 0], from_matrices(axes_of_points(earth[:, 0], earth[:, 1], earth[:, 2])))
    if not pose.shown.any():
        parts.notes.append(f"The plate {name!r} is left out: its first three points lie on a line.")
        return
    inverse = conjugate(pose.quaternion)
    local = np.stack([rotated(inverse, earth[:, k] - pose.position) for k in range(len(points))], axis=1)
    start = int(pose.shown.argmax())
    bent = float(np.linalg.norm(local[pose.shown] - local[start], axis=2).max())
    if bent > 1e-3:
        parts.notes.append(
            f"The plate {name!r} changes its form; it keeps that of the start, and a corner is off by "
            f"{1000.0 * bent:.2g} mm at most."
        )
    motion = Motion(pose.position, pose.quaternion)
    parts.free.append((name, motion, [(solids.plate(local[start], thickness), surface)]))


def _spring(parts: Parts, shape: Mapping[str, Any], name: str) -> None:
    usual = SHAPES["spring"]
    radius, coils = shape["radius"], shape.get("coils") or usual["coils"]
    wire = shape.get("wire") or usual["wire"] * radius
    a, b = (parts.poses.points(anchor) for anchor in shape["ends"])
    if shape.get("seat"):
        way = np.linalg.norm(b - a, axis=1)
        share = np.minimum(shape["seat"] / np.where(way > 0.0, way, np.inf), usual["most"])
        a = a + share[:, None] * (b - a)
    surface = look(shape, "paint", usual["color"], double=True)
    form = usual["dead"], usual["sides"], usual["per_turn"]
    _link(parts, name, a, b, surface, lambda length: solids.coil(radius, wire, length, coils, *form))
    seat = solids.cylinder(usual["rim"] * (radius + 0.5 * wire), -usual["plate"] * wire, 0.0, 24)
    for start, end in ((a, b), (b, a)):
        _pointing(parts, name, start, end, seat, look({}, "dark_paint"))


def _damper(parts: Parts, shape: Mapping[str, Any], name: str) -> None:
    usual = SHAPES["damper"]
    radius, ends = shape["radius"], shape["ends"]
    a, b = (parts.poses.points(anchor) for anchor in ends)
    length = np.linalg.norm(b - a, axis=1)
    part = min(usual["share"] * float(length[0]), usual["most"] * float(length.min()))
    if part <= 0.0:
        parts.notes.append(f"The damper {name!r} is left out: its length becomes zero.")
        return
    below = min(usual["below"][0] * radius, usual["below"][1] * part)
    tube = solids.cylinder(radius, min(radius, usual["foot"] * part), part)
    collar = solids.cylinder(usual["collar"] * radius, part - below, part + usual["above"] * radius)
    rod = solids.cylinder(usual["rod"] * radius, 0.0, part)
    _pointing(parts, name, a, b, tube, look(shape, "dark_paint"))
    _pointing(parts, name, a, b, collar, look({}, "steel"))
    _pointing(parts, name, b, a, rod, look({}, "chrome"))
    for anchor in ends:
        _ball(parts, anchor, usual["eye"] * radius, name, look({}, "steel"))


def _wheel(parts: Parts, shape: Mapping[str, Any], name: str) -> None:
    radius, width, frame = shape["radius"], shape["width"], shape["frame"]
    rim = shape.get("rim") or SHAPES["wheel"]["rim"] * radius
    y = _unit(shape.get("axis") or (0.0, 1.0, 0.0))
    body, own = parts.poses.of(parts.scene.get("focus") or GROUND), parts.poses.of(frame)
    along_axis = float(rotated(conjugate(own.quaternion[:1]), own.position[:1] - body.position[:1])[0] @ y)
    out = float(np.sign(along_axis)) if abs(along_axis) > 0.5 * radius else 0.0
    x = np.array([1.0, 0.0, 0.0]) - y[0] * y
    x = _unit(x) if abs(y[0]) < 0.9 else along(y)[:, 0]
    lengths = {"rim": rim, "side": radius - rim, "width": width}
    made = composed(SHAPES["wheel"]["parts"], lengths, out)
    _put(parts, shape, name, made, np.column_stack([x, y, np.cross(x, y)]))


def _steering_wheel(parts: Parts, shape: Mapping[str, Any], name: str) -> None:
    frame = shape["frame"]
    axis = _unit(shape.get("axis") or parts.scene["frames"].get(frame, {}).get("axis") or (0.0, 0.0, 1.0))
    pose = parts.poses.of(frame)
    up = rotated(conjugate(pose.quaternion[:1]), np.asarray(parts.scene.get("up") or (0.0, 0.0, 1.0), dtype=float))[0]
    top = up - (up @ axis) * axis
    z = _unit(top) if np.linalg.norm(top) > 1e-6 else along(axis)[:, 0]
    made = composed(SHAPES["steering_wheel"]["parts"], {"radius": shape["radius"]})
    _put(parts, shape, name, made, np.column_stack([np.cross(axis, z), axis, z]))


def _put(
    parts: Parts, shape: Mapping[str, Any], name: str, made: Iterable[tuple[Mapping[str, Any], Solid]], turn: Vectors
) -> None:
    """Put what a shape is composed of into its frame; what has the same material is one solid."""
    kinds: dict[Look, list[Solid]] = {}
    for part, solid in made:
        given = shape if part.get("of_shape") else {}
        surface = look(given, part["material"], part.get("color"), double=part.get("double", False))
        kinds.setdefault(surface, []).append(solid.placed(turn, _at(shape)))
    parts.fixed.append((shape["frame"], name, [(joined(same), surface) for surface, same in kinds.items()]))


_MAKERS: dict[str, Callable[[Parts, Mapping[str, Any], str], None]] = {
    "box": _box,
    "sphere": _sphere,
    "cylinder": _cylinder,
    "mesh": _mesh,
    "tube": _tube,
    "plate": _plate,
    "spring": _spring,
    "damper": _damper,
    "wheel": _wheel,
    "steering_wheel": _steering_wheel,
}


def _link(parts: Parts, name: str, a: Vectors, b: Vectors, surface: Look, make: Callable[[float], Solid]) -> None:
    """A solid along y from points a to points b, as long as at the start and scaled from there."""
    position, quaternion, length = between(a, b)
    size = float(length[0]) if length[0] > 0.0 else float(length.max())
    if size <= 0.0:
        return
    scale = None
    if float(np.abs(length - size).max()) > _CONSTANT * size:
        scale = np.column_stack([np.ones(len(length)), length / size, np.ones(len(length))])
    parts.free.append((name, Motion(position, quaternion, scale), [(make(size), surface)]))


def _pointing(parts: Parts, name: str, a: Vectors, b: Vectors, solid: Solid, surface: Look) -> None:
    """A rigid solid at points a whose y axis points to b."""
    position, quaternion, _ = between(a, b)
    parts.free.append((name, Motion(position, quaternion), [(solid, surface)]))


def _ball(parts: Parts, anchor: Sequence[Any], radius: float, name: str, surface: Look) -> None:
    parts.fixed.append((anchor[0], name, [(solids.sphere(radius, _RINGS).placed(np.eye(3), anchor[1]), surface)]))


def _rod(ends: Vectors, radius: float, sections: int = 32) -> Solid:
    to = ends[1] - ends[0]
    length = float(np.linalg.norm(to))
    return solids.cylinder(radius, 0.0, length, sections).placed(along(to / length), ends[0])


def _volume(positions: Vectors, triangles: NDArray[np.int64]) -> float:
    """Six times the volume that triangles enclose, negative where they face inwards."""
    a, b, c = (positions[triangles[:, k]] - positions.mean(axis=0) for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)))


def _unit(vector: Any) -> Vectors:
    made = np.asarray(vector, dtype=float)
    return np.asarray(made / np.linalg.norm(made))
