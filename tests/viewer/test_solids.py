"""Triangles of shapes and where they stand, for files: against closed forms."""

import re
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from ali3.scene.errors import ViewerError
from ali3.scene.recording import Recording
from tests.viewer.gltf_files import Part, content, parts_of, world
from tests.viewer.poses import FramePoses
from viewer import gltf
from viewer.gltf import WrittenGltf, write_gltf

T = np.linspace(0.0, 1.0, 41)
PLACES = {"car": (0.1, 0.2, 0.3), "left": (0.0, 0.9, 0.3), "right": (0.2, -0.9, 0.3)}
STRUT = [["car", [0.0, 0.0, 0.4]], ["left", [0.1, -0.3, 0.1]]]
SQUARE = [[0.0, 0.0, 0.0], [0.2, 0.0, 0.0], [0.2, 0.3, 0.0], [0.0, 0.3, 0.0]]
MIXED = [["car", SQUARE[0]], ["car", SQUARE[1]], ["left", SQUARE[2]], ["left", SQUARE[3]]]
SHAPES: dict[str, dict[str, Any]] = {
    "box": {"kind": "box", "frame": "car", "at": [0.1, 0.0, 0.0], "size": [0.2, 0.4, 0.3]},
    "cylinder": {"kind": "cylinder", "frame": "car", "ends": [[0.0, 0.6, 0.0], [0.1, 0.6, 0.4]], "radius": 0.08},
    "sphere": {"kind": "sphere", "frame": "car", "at": [0.1, 0.0, 0.0], "radius": 0.2},
    "left wheel": {"kind": "wheel", "frame": "left", "radius": 0.3, "width": 0.2},
    "right wheel": {"kind": "wheel", "frame": "right", "radius": 0.3, "width": 0.2, "rim": 0.22},
    "steering wheel": {"kind": "steering_wheel", "frame": "car", "radius": 0.2, "axis": [-0.8, 0.0, 0.6]},
    "damper": {"kind": "damper", "radius": 0.04, "ends": STRUT},
    "spring": {"kind": "spring", "radius": 0.07, "ends": STRUT, "coils": 5, "wire": 0.012},
    "tube": {"kind": "tube", "points": STRUT, "radius": 0.05},
    "plate": {"kind": "plate", "points": MIXED, "thickness": 0.01},
}


def moving() -> dict[str, np.ndarray]:
    """The left frame goes up and down and rolls, all others stand; quaternions turn gently."""
    results = {}
    for name, place in PLACES.items():
        roll = Rotation.from_rotvec(np.outer(0.4 * np.sin(5.0 * T) * (name == "left"), [1.0, 0.2, 0.0]))
        values = np.array(place) + np.outer(0.1 * np.sin(7.0 * T) * (name == "left"), [0.0, 0.0, 1.0])
        results |= {f"{name}.{a}": values[:, k] for k, a in enumerate("xyz")}
        results |= {f"{name}.q{a}": roll.as_quat(scalar_first=True)[:, k] for k, a in enumerate("wxyz")}
    return results


def scene() -> dict[str, Any]:
    def frame(name: str) -> dict[str, Any]:
        return {"position": [f"{name}.{a}" for a in "xyz"], "quaternion": [f"{name}.q{a}" for a in "wxyz"]}

    head = {"format": "ALi3 scene", "version": 1, "name": "shapes", "extent": 2.0, "focus": "car"}
    named = [{**shape, "name": name} for name, shape in SHAPES.items()]
    return {**head, "frames": {name: frame(name) for name in PLACES}, "shapes": named}


POSES = FramePoses(scene(), moving(), len(T))


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> WrittenGltf:
    return write_gltf(tmp_path_factory.mktemp("solids") / "shapes.glb", Recording(scene(), T, moving()), rate=240.0)


@pytest.fixture(scope="module")
def parts(written: WrittenGltf) -> list[Part]:
    return parts_of(written.path)


def named(parts: list[Part], name: str) -> list[Part]:
    return [part for part in parts if re.sub(r" \(\d+\)$", "", part.node) == name]


def motion(written: WrittenGltf, part: Part) -> NDArray[np.float64]:
    """Earth matrices at the times of the recording."""
    return world(written.path, T, part.node)


@pytest.mark.parametrize(
    ("name", "exact"),
    [("box", 0.024), ("cylinder", np.pi * 0.08**2 * np.hypot(0.1, 0.4)), ("sphere", 4.0 / 3.0 * np.pi * 0.2**3)],
)
def test_volume_and_place(parts, name, exact):
    """Corners are rounded, and what is round has flat sides."""
    (part,) = named(parts, name)
    assert part.frame == "car"
    assert part.mesh.volume == pytest.approx(exact, rel=0.03)
    expected = [0.05, 0.6, 0.2] if name == "cylinder" else [0.1, 0.0, 0.0]
    assert part.mesh.bounds.mean(axis=0) == pytest.approx(expected, abs=1e-6)


def test_normals_are_unit_and_point_out(parts):
    assert len(parts) > 20
    for part in parts:
        assert np.abs(np.linalg.norm(part.normals, axis=1) - 1.0).max() < 1e-6
        assert part.mesh.area_faces.min() > 0.0
        at = part.normals[part.mesh.faces].mean(axis=1)
        out = np.einsum("ij,ij->i", part.mesh.triangles_cross, at) > 0.0
        assert np.mean(out) > 0.98  # small bevels have the normals of what they join


def test_wheels_look_outwards(parts):
    """Brakes stand on the inner side of a rim, its nuts and spokes on the outer one."""
    for name, out in (("left wheel", 1.0), ("right wheel", -1.0)):
        actual = {p.look["name"]: p.mesh for p in named(parts, name) if p.frame == name.partition(" ")[0]}
        middle = {look: mesh.bounds.mean(axis=0)[1] for look, mesh in actual.items()}
        assert middle["plastic"] * out > 0.0 > middle["steel"] * out
        reach = np.hypot(*actual["rubber"].vertices[:, [0, 2]].T).max()
        assert reach == pytest.approx(0.3, rel=1e-6)
        assert np.ptp(actual["rubber"].vertices[:, 1]) == pytest.approx(0.2, rel=0.01)


def test_the_mark_of_a_steering_wheel_is_on_top(parts):
    looks = ((part.mesh, part.look["pbrMetallicRoughness"]) for part in named(parts, "steering wheel"))
    (mark,) = (mesh for mesh, look in looks if look["baseColorFactor"][0] > 0.5)
    top = np.array([0.6, 0.0, 0.8])  # across the axis, upwards
    assert mark.vertices.mean(axis=0) @ top == pytest.approx(0.91 * 0.2, rel=0.02)


def ends_of(name: str) -> tuple[np.ndarray, np.ndarray]:
    shape = SHAPES[name]
    a, b = (POSES.points(anchor) for anchor in (shape.get("ends") or shape["points"]))
    return a, b


@pytest.mark.parametrize(("name", "tolerance"), [("tube", 1e-6), ("spring", 5e-4)])  # a wire has seven sides
def test_shapes_between_two_frames_reach_from_end_to_end(written, parts, name, tolerance):
    begin, end = ends_of(name)
    part = next(part for part in named(parts, name) if part.frame == "shapes")
    found = motion(written, part)
    local = np.linalg.inv(found[0]) @ np.vstack([part.mesh.vertices.T, np.ones(len(part.mesh.vertices))])
    for y, exact in ((local[1].min(), begin), (local[1].max(), end)):
        assert np.abs((found @ [0.0, y, 0.0, 1.0])[:, :3] - exact).max() < tolerance
    assert np.ptp(np.linalg.norm(end - begin, axis=1)) > 0.05
    size = np.linalg.norm(found[:, :3, :3], axis=1)
    assert np.abs(size[:, [0, 2]] - size[0, 0]).max() < 1e-6  # only its length changes
    turn = found[:, :3, :3] / size[:, None, :]
    turned = Rotation.from_matrix(turn[1:] @ turn[:-1].transpose(0, 2, 1)).magnitude()
    y = turn[:, :, 1]
    swung = np.arctan2(np.linalg.norm(np.cross(y[1:], y[:-1]), axis=1), np.einsum("ni,ni->n", y[1:], y[:-1]))
    assert np.abs(turned - swung).max() < 1e-5, "it does not twist"


def test_balls_stand_in_the_frames_of_their_ends(parts):
    for name in ("tube", "damper"):
        actual = {part.frame: part.mesh.vertices.mean(axis=0) for part in named(parts, name) if part.frame != "shapes"}
        ends = SHAPES[name].get("ends") or SHAPES[name]["points"]
        assert actual.keys() == {"car", "left"}
        for frame, place in ends:
            assert actual[frame] == pytest.approx(place, abs=1e-6)


def test_rods_of_a_damper_keep_their_length(written, parts):
    begin, end = ends_of("damper")
    rods = [part for part in named(parts, "damper") if part.frame == "shapes"]
    assert sorted(part.look["name"] for part in rods) == ["chrome", "dark_paint", "steel"]
    for part in rods:
        found = motion(written, part)
        size = np.linalg.norm(found[:, :3, :3], axis=1)
        assert np.abs(size - size[0]).max() < 1e-6
        along = (end - begin) / np.linalg.norm(end - begin, axis=1)[:, None]
        assert np.abs(np.cross(found[:, :3, 3] - begin, along)).max() < 1e-6


def test_a_bending_plate_keeps_its_form_and_is_reported(written):
    (note,) = (note for note in written.notes if "form" in note)
    corners = np.stack([POSES.points(anchor) for anchor in MIXED], axis=1)
    apart = np.linalg.norm(corners[:, 2] - corners[:, 0], axis=1)
    least = 1000.0 * np.abs(apart - apart[0]).max()
    deviation = float(note.split("off by ")[1].split()[0])
    assert note.startswith("The plate 'plate' changes its form; it keeps that of the start, ")
    assert least < deviation < 1000.0


def test_places_far_away_are_of_double_precision(tmp_path):
    far = [500_123.456, 5_400_123.4, 112.3]
    boxes = [{"kind": "box", "frame": "ground", "at": far, "size": [1.0, 1.0, 1.0]}]
    boxes.append({"kind": "tube", "points": [["ground", far], ["ground", [*far[:2], 113.3]]], "radius": 0.1})
    by = dict(zip([".x", ".y", ".z"], far, strict=True))
    columns = {name: values + by.get(name[-2:], 0.0) for name, values in moving().items()}
    result = write_gltf(tmp_path / "far.glb", Recording({**scene(), "shapes": boxes}, T, columns))
    origin = content(result.path)[0]["scenes"][0]["extras"]["origin"]
    results = [part.mesh.bounds.mean(axis=0) + origin for part in parts_of(result.path)]
    for middle in (far, [*far[:2], 112.8]):
        assert min(np.abs(place - middle).max() for place in results) < 2e-5


def test_a_program_that_fails_is_one_sentence(monkeypatch, tmp_path):
    failed = subprocess.CompletedProcess(
        [], 1, b"", b"a.mjs:1\n^\n\nRangeError: out of memory\n    at a.mjs:1\n\nNode.js v24"
    )
    monkeypatch.setattr(subprocess, "run", lambda *_, **__: failed)
    monkeypatch.setattr(gltf, "bundle", lambda: Path("viewer.js"))
    with pytest.raises(
        ViewerError, match=r"^A glTF file cannot be written: .* failed \(RangeError: out of memory\)\.$"
    ):
        write_gltf(tmp_path / "a.glb", Recording(scene(), T, moving()))


def test_a_program_that_does_not_start_is_one_sentence(monkeypatch, tmp_path):
    monkeypatch.setattr(gltf, "node_and_npm", lambda: (str(tmp_path / "node"), ""))
    monkeypatch.setattr(gltf, "bundle", lambda: Path("viewer.js"))
    with pytest.raises(ViewerError, match=r"^A glTF file cannot be written: .*node does not start: no such file"):
        write_gltf(tmp_path / "a.glb", Recording(scene(), T, moving()))
