"""Scene of a model: all that is drawn but the columns of a run."""

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ali3.scene import scene_parts
from ali3.scene.base64_numbers import encoded
from mbs.common.checks import Vector
from mbs.common.vectors import in_space
from mbs.elements.road import PortRoad
from mbs.flexible.scene_part import flexible_parts
from mbs.model.checked_shapes import Shape
from mbs.model.flexible import FlexibleBody
from mbs.model.joints.joint import Joint
from mbs.model.model import Model
from mbs.model.table_bodies import LookupTableBody
from mbs.roads.scene_part import scene_part
from mbs.shapes.arrows import force_arrows
from mbs.shapes.default_shapes import Defaults
from mbs.shapes.frames import FrameNames, frames_of, numbers, place_drawn
from mbs.shapes.joint_points import joint_geometry
from mbs.system.drawing import Drawing, Places, matrices

LOOKUP_TABLE_REASON = "a table moves it, and pictures follow coordinates"
SLIDING_REASON = "one of its ends slides by a driving function, which no sensor reads (sense_guide)"
Scene = dict[str, Any]
JOINT_TYPES = ("spherical", "revolute", "universal", "weld")
"""Types of joints that constrain a common point."""
OFFSET = 0.1  # m, from the point of a joint to further common points


def drawing_of(model: Model, places: Places, names: FrameNames, q: NDArray[np.float64]) -> Drawing:
    """Scene of a model, with its rows for the poses of frames.

    `places`: rows of its frames by coordinates; `q`: coordinates at the start, shape (nq,).
    """
    geometry = joint_geometry(model, names)
    meshes: dict[str, Any] = {}
    shapes = [s for shape in model.shapes if (s := _shape_entry(shape, names, meshes)) is not None]
    extent = _extent([*_body_points(model), *(p for ps in geometry.points.values() for p in ps)])
    defaults = Defaults(model, names, geometry, extent)
    for shape in shapes:
        _set_default_sizes(shape, defaults)
    named = {s.name for s in model.shapes} - {""}
    if model.default_shapes:
        drawn_frames = {names.of_owner(s.owner) for s in model.shapes}
        shapes += defaults.all(drawn_frames, named)
    frames = frames_of(model, names, places, q)
    used_frames = {frame for shape in shapes for frame in scene_parts.frames_of(shape)}
    frames |= {name: frame for name, frame in geometry.frames.items() if name in used_frames}
    rails = {slide.joint.name for slide in geometry.slides}
    measured_shapes = [shape for shape in shapes if shape.get("name") not in rails]
    scene: Scene = {
        "format": "ALi3 scene",
        "version": 1,
        "name": model.name,
        "description": "",
        "up": _up_direction(model),
        "planar": model.dimension == 2,
        "extent": _extent([*_shape_points(measured_shapes, frames), *_flexible_nodes(model)])
        if measured_shapes
        else extent,
        "focus": _focus_frame(model, names),
        "frames": frames,
        "shapes": shapes,
        "meshes": meshes,
        "flexible": list(model.flexible_scene),
        "arrows": force_arrows(model, names, geometry.lines),
        "roads": road_entries(model),
        "missing": [{"name": name, "why": SLIDING_REASON} for name in geometry.sliding if name not in named]
        + [
            {"name": t.name, "why": LOOKUP_TABLE_REASON}
            for t in model.lookup_tables
            if isinstance(t, LookupTableBody) and not t.outputs
        ],
    }
    return Drawing(scene, places, shared_points(model, names), _flexible_part_makers(model, names, places, q))


def _shape_entry(shape: Shape, names: FrameNames, meshes: dict[str, Any]) -> Scene | None:
    """Entry of the scene for a shape of the user; None for a hidden shape."""
    if shape.kind == "none":
        return None
    entry: Scene = {"kind": shape.kind}
    frame, fields = names.of_owner(shape.owner), dict(shape.fields)
    anchors = [[names.of_owner(of), numbers(position)] for of, position in shape.anchors]
    if shape.kind in ("tube", "plate"):
        entry["points"] = anchors
    elif shape.kind in ("spring", "damper"):
        entry["ends"] = anchors
    else:
        entry["frame"] = frame
        if shape.kind == "cylinder":
            entry["ends"] = [position for _, position in anchors]
    if shape.kind == "mesh":
        name = _mesh_name(fields.pop("file"), meshes)
        meshes[name] = {
            "positions": encoded(fields.pop("positions")),
            "triangles": encoded(fields.pop("triangles"), "u"),
        }
        entry["mesh"] = name
    if "axes" in fields:
        entry["axes"] = [numbers(column) for column in np.asarray(fields.pop("axes")).T]
    plain_fields = {k: numbers(v) if isinstance(v, np.ndarray) else v for k, v in fields.items()}
    owner = getattr(shape.owner, "name", "")
    return entry | plain_fields | ({"body": owner} if owner else {})


def _mesh_name(file: str, meshes: Mapping[str, Any]) -> str:
    """Name of a file, with a number if a mesh has this name."""
    name, k = file, 2
    while name in meshes:
        name, k = f"{file} ({k})", k + 1
    return name


def _set_default_sizes(shape: Scene, defaults: Defaults) -> None:
    """Set the sizes that the user omitted."""
    tube = defaults.tube_radius
    if shape["kind"] in ("tube", "spring", "damper"):
        shape.setdefault("radius", tube * {"tube": 1.0, "spring": 2.0, "damper": 1.0}[shape["kind"]])
    if shape["kind"] == "plate":
        shape.setdefault("thickness", tube)


def _flexible_part_makers(
    model: Model, names: FrameNames, places: Places, q: NDArray[np.float64]
) -> tuple[Callable[[], list[Scene]], ...]:
    """Functions that make the scene parts of flexible bodies: beams, modes and stress rows."""
    functions = []
    bodies = [body for body in model.bodies if isinstance(body, FlexibleBody)]
    hidden = {shape.owner for shape in model.shapes if shape.kind == "none"}
    for body, amplitudes in zip(bodies, places.amplitudes, strict=True):
        if body in hidden:
            continue
        start = places.rows(q[None], amplitudes.row, len(amplitudes.modes))[0]
        frame = names.of_body(body)
        options = {"axes": body.axes, "start": start, "gauges": body.gauges}
        functions.append(partial(flexible_parts, body.reduced, frame, amplitudes.columns, **options))
    return tuple(functions)


def _up_direction(model: Model) -> list[float]:
    """Unit vector against gravity, z without gravity; y in planar models."""
    if model.dimension == 2:
        return [0.0, 1.0, 0.0]
    size = float(np.linalg.norm(model.gravity))
    return numbers(-model.gravity / size) if size > 0.0 else [0.0, 0.0, 1.0]


def _focus_frame(model: Model, names: FrameNames) -> str:
    """Frame of the heaviest body of a model that is not joined to the ground; otherwise empty."""
    if model.grounded and not model.floating:
        return ""
    return names.of_body(max(model.bodies, key=lambda body: body.mass))


def _body_points(model: Model) -> list[Vector]:
    """Nodes and centres of mass as drawn, m; of a single rigid body the box of its radius of gyration."""
    positions: list[Vector] = []
    for body in model.bodies:
        nodes = body.node_positions if isinstance(body, FlexibleBody) else [body.com]
        positions += [in_space(p) for p in nodes]
    if len(positions) == 1 and not isinstance(model.bodies[0], FlexibleBody) and not model.bodies[0].is_point:
        body = model.bodies[0]
        radius = float(np.sqrt(np.trace(body.second_moment) / body.mass))
        positions += [positions[0] - radius, positions[0] + radius]
    return positions


def _flexible_nodes(model: Model) -> list[Vector]:
    """Nodes of all flexible bodies as drawn, m."""
    return [p for body in model.bodies if isinstance(body, FlexibleBody) for p in body.node_positions]


def _extent(points: list[Vector]) -> float:
    """Diagonal of the bounding box of points, m; 1 m if they coincide."""
    size = float(np.linalg.norm(np.ptp(points, axis=0))) if points else 0.0
    return size if size > 0.0 else 1.0


def _shape_points(shapes: list[Scene], frames: Mapping[str, Any]) -> list[Vector]:
    """Corners of the boxes around the points of all shapes at the start, earth axes, m."""
    corners: list[Vector] = []
    starts = _initial_poses(frames)
    for shape in shapes:
        anchors = [*shape.get("points", ()), *(shape.get("ends", ()) if "frame" not in shape else ())]
        if "frame" in shape:
            local = shape.get("ends") or [shape.get("at", [0.0, 0.0, 0.0])]
            anchors = [[shape["frame"], p] for p in local]
        reach = shape["radius"] if shape["kind"] in ("sphere", "wheel") else 0.5 * max(shape.get("size", [0.0]))
        for frame, p in anchors:
            position = _initial_position(frames, starts, frame, np.array(p))
            corners += [position - reach, position + reach]
    return corners


def _initial_poses(frames: Mapping[str, Any]) -> dict[str, tuple[Vector, Vector]]:
    """Origin and axes of the frames of bodies at the start."""
    poses = {name: frame["start"] for name, frame in frames.items() if "parent" not in frame}
    if not poses:
        return {}
    axes = matrices(np.array([quaternion for _, quaternion in poses.values()]))
    return {name: (np.array(origin), R) for (name, (origin, _)), R in zip(poses.items(), axes, strict=True)}


def _initial_position(
    frames: Mapping[str, Any], starts: Mapping[str, tuple[Vector, Vector]], name: str, point: Vector
) -> Vector:
    """Position at the start of a point of the frame `name`, earth axes, m; `point`: position in the frame, m."""
    if name == "ground":
        return point
    if name not in starts:  # the angle at the start is neglected: it does not change the extent
        frame = frames[name]
        return _initial_position(frames, starts, frame["parent"], np.array(frame["at"]) + point)
    origin, axes = starts[name]
    return np.asarray(origin + axes @ point)


def road_entries(model: Model) -> list[dict[str, Any]]:
    """Entries of all roads, and of the level planes on which wheels roll without slip.

    A road file is entered by its path. A road at a port is left out because only the host knows its heights; the roads
    after it keep their numbers.
    """
    # without a path the road of the model is used
    files_by_road = {file.road: file for file in model.road_files if file.start}
    entries: list[tuple[int, dict[str, Any]]] = []
    for number, road in enumerate(model.roads):
        if isinstance(road, PortRoad):
            continue
        file = files_by_road.get(number)
        entry = scene_part(road) if file is None else {"kind": "file", "variable": file.name, "path": file.start}
        entries.append((number, entry))
    plane_levels = sorted({joint.rolls.level for joint in model.joints if joint.rolls is not None})
    for number, level in enumerate(plane_levels, len(model.roads)):
        entries.append((number, {"kind": "flat", "height": level}))
    # an entry without a number has the number of its position
    return [
        entry if number == position else entry | {"number": number} for position, (number, entry) in enumerate(entries)
    ]


def shared_points(model: Model, names: FrameNames) -> list[tuple[str, list[float], str, list[float]]]:
    """Common points of all joints: for each point two frames and its coordinates in both, m.

    A joint with an axis gives two points on it, a weld three. In a flexible body the coordinates are those in its
    floating frame, without the deformation at the node. Joints that a parameter switches off are left out.
    """
    points, drawn = [], model.drawn()
    for joint in model.joints:
        ends = joint.ends
        if ends is None or joint.type not in JOINT_TYPES or joint.switch is not None:
            continue
        if any(body.is_point for body in ends.bodies):
            continue
        positions = [place_drawn(drawn, point) for point in ends.points]
        for offset in _offsets(model.dimension, drawn, joint):
            (frame_1, r_1), (frame_2, r_2) = (
                names.anchor(body, position + offset) for body, position in zip(ends.bodies, positions, strict=True)
            )
            points.append((frame_1, numbers(r_1), frame_2, numbers(r_2)))
    return points


def _offsets(dimension: int, drawn: Vector, joint: Joint) -> list[Vector]:
    """Vectors from the point of a joint to all common points of its bodies, m."""
    offsets = [np.zeros(3)]
    if joint.type == "weld":
        offsets += [OFFSET * e for e in np.eye(3)[:2]]
    elif joint.type == "revolute" and dimension == 2:
        offsets.append(np.array([0.0, 0.0, OFFSET]))
    elif joint.type == "revolute" and joint.ends is not None and joint.ends.axis is not None:
        offsets.append(OFFSET * place_drawn(drawn, joint.ends.axis))
    return offsets
