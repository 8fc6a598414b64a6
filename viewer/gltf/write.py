"""Writes a recording as a glTF 2.0 animation."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ali3.extras import missing_module
from ali3.files import atomic_file, check_writable
from ali3.scene.errors import ViewerError
from ali3.scene.recording import Recording
from ali3.scene.written_file import WrittenGltf
from viewer.gltf.flexible import flexible_part
from viewer.gltf.materials import Look
from viewer.gltf.motion import Motion, Track, kept_times, largest_errors, thinned
from viewer.gltf.paths import path_solids
from viewer.gltf.roads import road_solid, surfaces_of
from viewer.gltf.scenery import by_the_way
from viewer.gltf.solids import Solid, parts_of
from viewer.gltf.terrain import earth_axes, surface_look, terrain_solids
from viewer.poses import GROUND, FramePoses, Vectors, about_axis, shortest_turns

if TYPE_CHECKING:
    from viewer.gltf.document import Document

SUFFIXES = (".glb", ".gltf")
MOST_RATE = 240.0
_LOOKED_AT = 20_000  # times of a recording that errors are found at, at least two for each that is written
_NEAR = 1000.0  # m from the origin: single precision is then within 0.03 mm
_AROUND = 60.0  # m: what of a world is drawn beside the way
_FAR = 2e-3  # of the size of the scene: what a reader would see
_ROAD = Look("road", (0.08, 0.08, 0.085, 1.0), 0.0, 0.9)
_WHITE = Look("stress", (1.0, 1.0, 1.0, 1.0), 0.1, 0.6)
_FRAME = Look("steel", (0.27, 0.31, 0.34, 1.0), 0.85, 0.42)


def write_gltf(
    path: str | os.PathLike[str],
    recording: Recording,
    *,
    rate: float = 60.0,
    speed: float = 1.0,
    deformation: float = 1.0,
    road: bool = True,
) -> WrittenGltf:
    """Write the motion of a recording as a glTF 2.0 file with shapes, materials and one animation.

    Lengths are in metres and y is up, as glTF has it. The node of a frame has its name and moves with it; time 0 is
    the first of the recording. Farther than 1 km from the origin places are relative to one near the motion, which a
    note tells and the extras of the scene and of its first node have as ``origin``: earth axes, m. Motion is linear
    between the times, rotations go along great arcs. Flexible parts move by morph targets and have the colours of
    their stress at the time when it is largest, because glTF has no colours over time. Roads, scenery and the whole
    path are there as far as they are near the way. Arrows, plots, ghosts, marks and cameras are not in the file.

    Parameters
    ----------
    path : path
        ``.glb``, one binary file, or ``.gltf``, one text file; an older one is replaced when the new one is whole.
    rate : float
        Times a second of the file that are kept at most, 1 to 240 Hz; a part that turns far between two of them has
        more.
    speed : float
        Of the animation; 1 is real time, 0.01 slow motion.
    deformation : float
        Factor of the drawn deformation.
    road : bool
        Whether roads, the surroundings and the path are drawn.

    Returns
    -------
    WrittenGltf
        Where it is, how large, and what was lost by thinning.

    Raises
    ------
    ViewerError
        The recording has no scene, nothing of it can be drawn, or an argument is wrong.
    FileError
        The file cannot be written; an older one is then unchanged.
    """
    target = Path(path)
    scene = _checked(target, recording, rate, speed, deformation)
    check_writable(path)
    if not road:
        scene |= {"roads": [], "scenery": []}
    writer = _Writer(scene, recording, rate, float(speed), deformation)
    if not (writer.parts.fixed or writer.parts.free or writer.flexible):
        raise ViewerError(f"{recording.name!r} has no shape that can be drawn; there is nothing to write to {path}.")
    if road:
        writer.add_roads()
    writer.write_nodes()
    with atomic_file(path) as made:
        writer.document.save(made)
        size = made.stat().st_size
    notes = list(recording.notes)
    notes += [f"{item['name']} is not drawn: {item['why']}" for item in recording.missing]
    notes += writer.notes()
    return WrittenGltf(target, size, writer.times, 1000.0 * writer.error[0], math.degrees(writer.error[1]), notes)


def _checked(target: Path, recording: Recording, rate: float, speed: float, deformation: float) -> dict[str, Any]:
    if target.suffix.lower() not in SUFFIXES:
        raise ViewerError(f"{target} must end with .glb or .gltf.")
    if not isinstance(recording, Recording):
        raise ViewerError(f"A recording is needed; this is an object of type {type(recording).__name__}.")
    if recording.scene is None:
        raise ViewerError(f"{recording.name!r} has no scene: there are no shapes to write to {target}.")
    limits = (("rate", rate, 1.0, MOST_RATE), ("speed", speed, 1e-6, 1e4), ("deformation", deformation, 0.0, 1e6))
    for name, value, low, high in limits:
        good = isinstance(value, (int, float, np.number)) and not isinstance(value, bool)
        if not good or not low <= value <= high:
            raise ViewerError(f"The {name} is {value!r}; it must be a number from {low:g} to {high:g}.")
    return dict(recording.scene)


def _document(name: str) -> Document:
    try:
        from viewer.gltf.document import Document
    except ModuleNotFoundError as error:
        raise ViewerError(f"A glTF file cannot be written. {missing_module(error)}") from None
    return Document(name)


class _Writer:
    """Collects shapes, then writes nodes, frames before what hangs on them."""

    def __init__(
        self, scene: dict[str, Any], recording: Recording, rate: float, speed: float, deformation: float
    ) -> None:
        self.document = _document(recording.name)
        self._scene = scene
        self._rate = rate
        t = (recording.t - recording.t[0]) / speed
        span = float(t[-1])
        looked = kept_times(t, max(2.0 * rate, min(8.0 * rate, _LOOKED_AT / span)) if span > 0.0 else rate)
        self._t: Vectors = t[looked]
        self._epoch = recording.epoch[looked]
        self._speed = speed
        self._columns: Mapping[str, NDArray[Any]] = {name: values[looked] for name, values in recording.columns.items()}
        self._poses = FramePoses(scene, self._columns, len(self._t))
        self._deformation = deformation
        self.times = len(kept_times(self._t, rate))
        self.error = (0.0, 0.0)
        self._nodes: dict[str, int] = {}
        self._frame_errors: dict[str, tuple[float, float]] = {GROUND: (0.0, 0.0)}
        up = np.array(scene.get("up") or (0.0, 0.0, 1.0), dtype=float)
        self._up: Vectors = up / np.linalg.norm(up)
        self._axes = earth_axes(self._up)
        places = np.vstack([self._poses.of(name).position for name in scene["frames"]] or [np.zeros((1, 3))])
        self._low, self._high = places.min(axis=0), places.max(axis=0)
        corners = np.stack([self._low, self._high]) @ self._axes[:2].T
        self._near, self._far = corners.min(axis=0) - _AROUND, corners.max(axis=0) + _AROUND
        things = scene.get("scenery") or []
        by_way = by_the_way(things, self._near, self._far)
        self.parts = parts_of({**scene, "scenery": by_way}, self._poses, len(self._t))
        self._left_out = len(things) - len(by_way)
        self.flexible = list(zip(scene.get("flexible") or [], self.parts.flexible, strict=True))
        turn = shortest_turns(self._up[None], np.array([[0.0, 1.0, 0.0]]))[0]
        taken = recording.name in scene["frames"]  # frames have their names
        self._root = self.document.node(f"scene {recording.name}" if taken else recording.name, None)
        self.document.place(self._root, "rotation", turn)
        self._begin = float(recording.t[0])
        self._origin = self._middle()
        if self._origin.any():
            self.document.report_origin(self._root, self._origin)

    def _middle(self) -> Vectors:
        """What is taken from all places in earth axes, m: whole metres, and 0 near the origin."""
        if np.maximum(-self._low, self._high).max() < _NEAR:
            return np.zeros(3)
        return np.asarray(np.round(0.5 * (self._low + self._high)))

    def add_roads(self) -> None:
        """Roads without an end reach as far as the frames go, and twice the size of the scene beyond."""
        half = 0.5 * float(np.linalg.norm(self._high - self._low)) + 2.0 * float(self._scene["extent"])
        for road in self._scene.get("roads") or []:
            if road["kind"] == "terrain":
                self._add_terrain(road)
                continue
            made = road_solid(road, self._up, 0.5 * (self._low + self._high), half)
            if made is None:
                self.parts.notes.append("The road of a file is not drawn.")
                continue
            looks = {name: surface_look(name) for name in ("wet", "ice")} | {"asphalt": _ROAD}
            meshes = [(solid, looks[name]) for name, solid in surfaces_of(road, made[0]).items()]
            self.parts.fixed.append((GROUND, "road", meshes))
            if made[1] > 1:
                self.parts.notes.append(f"Of the grid of the road every {made[1]}th point is drawn in each direction.")
        for kind, solid in self.parts.things.items():
            assert solid.normals is not None  # the makers of scenery give them
            turned = replace(solid, positions=solid.positions @ self._axes, normals=solid.normals @ self._axes)
            self.parts.fixed.append(
                (GROUND, kind, [(turned, Look(kind, (1.0, 1.0, 1.0, 1.0), 0.0, 0.85, double=True))])
            )
        if self._left_out:
            self.parts.notes.append(
                f"{self._left_out} things of the scenery are left out; the others stand by the way."
            )
        paths = path_solids(self._scene, self._poses, self._up, self._epoch)
        self.parts.fixed += [(GROUND, name, [(band, look)]) for name, band, look in paths]

    def _add_terrain(self, road: Mapping[str, Any]) -> None:
        """What of a terrain lies in a rectangle about the way."""
        made, error = terrain_solids(road, self._axes, self._near, self._far)
        self.parts.fixed.append((GROUND, "terrain", made))
        self.parts.notes.append(
            f"Of the terrain, what is within {_AROUND:g} m of the way is drawn; its heights are up to "
            f"{1000.0 * error:.2g} mm off."
        )

    def write_nodes(self) -> None:
        """Frames first, so that they have their names."""
        for name in [*(frame for frame, _, _ in self.parts.fixed), *(part["frame"] for part, _ in self.flexible)]:
            self._frame(name)
        for name, motion, meshes in self.parts.free:
            motion.position = motion.position - self._origin
            node = self.document.node(name, self._root, self.document.mesh(name, meshes))
            motion.reach = _corners([solid.positions for solid, _ in meshes])
            self._count(self._animate(node, motion))
        for frame, name, meshes in self.parts.fixed:
            if frame == GROUND:
                meshes = [(replace(solid, positions=solid.positions - self._origin), look) for solid, look in meshes]
            self.document.node(name, self._frame(frame), self.document.mesh(name, meshes))
        for part, solid in self.flexible:
            self._write_flexible(part, solid)

    def notes(self) -> list[str]:
        """What there is to say of the file."""
        made = list(self.parts.notes)
        if self._origin.any():
            x, y, z = self._origin
            made.append(
                f"Places are relative to x = {x:.0f} m, y = {y:.0f} m, z = {z:.0f} m, for numbers of a glTF file have "
                "seven digits; the extras of the scene and of its first node have them as origin."
            )
        if self._begin != 0.0:
            made.append(f"Time 0 of the file is {self._begin:g} s of the recording.")
        if self._speed != 1.0:
            made.append(f"A second of the file is {self._speed:g} s of the recording.")
        if self.error[0] > _FAR * float(self._scene["extent"]):
            made.append(
                f"Between the {self.times} times that were kept, something is up to {1000.0 * self.error[0]:.3g} mm "
                "from where it was recorded; a higher rate or a lower speed keeps more times."
            )
        for name in self._nodes:
            shown = self._poses.of(name).shown
            if not shown.all():
                made.append(f"{name} stands still while its columns hold no numbers, {int((~shown).sum())} times.")
        if self._scene.get("arrows"):
            made.append("The arrows of forces are not in a glTF file.")
        return made

    def _frame(self, name: str) -> int:
        """The node of a frame; it and those that it hangs on are made when they are first needed."""
        if name in self._nodes:
            return self._nodes[name]
        frame = self._scene["frames"].get(name, {})
        pose = self._poses.of(name)
        parent, before = self._root, (0.0, 0.0)
        motion = Motion(pose.position, pose.quaternion)
        if "parent" in frame:
            parent = self._frame(frame["parent"])
            before = self._frame_errors[frame["parent"]]
            self._relative(motion, frame)
        if name != GROUND and frame.get("parent", GROUND) == GROUND:
            motion.position = motion.position - self._origin
        reach = [s.positions for frame_name, _, meshes in self.parts.fixed if frame_name == name for s, _ in meshes]
        reach += [np.array(part["nodes"], dtype=float) for part, _ in self.flexible if part["frame"] == name]
        motion.reach = _corners(reach) if reach else motion.reach
        self._nodes[name] = node = self.document.node(name, parent)
        if name != GROUND:
            off = self._animate(node, motion)
            self._frame_errors[name] = before[0] + off[0], before[1] + off[1]
            self._count(self._frame_errors[name])
        return node

    def _relative(self, motion: Motion, frame: dict[str, Any]) -> None:
        """The motion of a frame that turns or slides in its parent."""
        motion.position = np.tile(np.array(frame.get("at") or (0.0, 0.0, 0.0), dtype=float), (len(self._t), 1))
        motion.quaternion = np.tile([1.0, 0.0, 0.0, 0.0], (len(self._t), 1))
        if "way" in frame:
            way = _filled(np.asarray(self._columns[frame["way"]], dtype=float))
            motion.position += way[:, None] * np.asarray(frame["direction"], dtype=float)
        else:
            angle = _filled(np.asarray(self._columns[frame["angle"]], dtype=float))
            motion.angle = np.asarray(frame["axis"], dtype=float), angle
            motion.quaternion = about_axis(frame["axis"], angle)

    def _animate(self, node: int, motion: Motion) -> tuple[float, float]:
        """Give a node its motion; what does not change is written once. Its largest errors, m and rad."""
        track = thinned(motion, self._t, self._rate)
        self._write_track(node, track)
        written = replace(track, position=np.float32(track.position).astype(float))
        return largest_errors(motion, written, self._t)

    def _write_track(self, node: int, track: Track) -> None:
        for path, values in (("translation", track.position), ("rotation", track.quaternion), ("scale", track.scale)):
            if values is None:
                continue
            self.document.place(node, path, values[0])  # for readers that do not animate
            if (np.float32(values) != np.float32(values[0])).any():
                self.document.channel(node, path, track.times, values)

    def _write_flexible(self, part: dict[str, Any], solid: Solid) -> None:
        name = part.get("name") or f"flexible {part['frame']}"
        made = flexible_part(part, solid, self._columns, self._deformation)
        look = _FRAME if made.colors is None else _WHITE
        mesh = self.document.mesh(name, [(replace(solid, colors=made.colors), look)], made.targets)
        node = self.document.node(name, self._frame(part["frame"]), mesh)
        if made.targets:
            kept = kept_times(self._t, self._rate)
            if len(kept) > 1:
                self.document.channel(node, "weights", self._t[kept], made.weights[kept])
            else:
                self.document.set_weights(mesh, made.weights[0])
        off = made.reduction_error
        self._count((self._frame_errors[part["frame"]][0] + off, 0.0))
        if made.peak is not None:
            time, stress, end = made.peak
            unit = part["stress"].get("unit", "Pa")
            self.parts.notes.append(
                f"The colours of {name} are those of its largest stress, {stress:.3g} {unit}, at "
                f"{self._t[time] * self._speed + self._begin:.3g} s; they go from 0 to {end:.3g} {unit}."
            )

    def _count(self, off: tuple[float, float]) -> None:
        self.error = max(self.error[0], off[0]), max(self.error[1], off[1])


def _corners(positions: list[Vectors]) -> Vectors:
    """Corners of the box about points."""
    points = np.vstack(positions)
    low, high = points.min(axis=0), points.max(axis=0)
    return np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])


def _filled(values: Vectors) -> Vectors:
    """Values with those that are not numbers as the one before."""
    good = np.isfinite(values)
    source = np.maximum.accumulate(np.where(good, np.arange(len(values)), -1))
    source[source < 0] = int(good.argmax())
    return values[source]
