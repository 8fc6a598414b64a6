"""Triangles of shapes and where they stand, for files: against closed forms."""

import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from ali3.scene.errors import ViewerError
from viewer.gltf import solids
from viewer.gltf.solids import Parts, Solid, joined, parts_of
from viewer.poses import FramePoses, rotated

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
    made = {}
    for name, place in PLACES.items():
        roll = Rotation.from_rotvec(np.outer(0.4 * np.sin(5.0 * T) * (name == "left"), [1.0, 0.2, 0.0]))
        values = np.array(place) + np.outer(0.1 * np.sin(7.0 * T) * (name == "left"), [0.0, 0.0, 1.0])
        made |= {f"{name}.{a}": values[:, k] for k, a in enumerate("xyz")}
        made |= {f"{name}.q{a}": roll.as_quat(scalar_first=True)[:, k] for k, a in enumerate("wxyz")}
    return made


def scene() -> dict[str, Any]:
    def frame(name: str) -> dict[str, Any]:
        return {"position": [f"{name}.{a}" for a in "xyz"], "quaternion": [f"{name}.q{a}" for a in "wxyz"]}

    head = {"format": "ALi3 scene", "version": 1, "name": "shapes", "extent": 2.0, "focus": "car"}
    named = [{**shape, "name": name} for name, shape in SHAPES.items()]
    return {**head, "frames": {name: frame(name) for name in PLACES}, "shapes": named}


POSES = FramePoses(scene(), moving(), len(T))


@pytest.fixture(scope="module")
def parts() -> Parts:
    return parts_of(scene(), POSES, len(T))


def fixed(parts: Parts, name: str) -> list[tuple[str, Solid, str]]:
    return [(f, solid, look.name) for f, n, meshes in parts.fixed if n == name for solid, look in meshes]


def volume(solid: Solid) -> float:
    a, b, c = (solid.positions[solid.triangles[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


@pytest.mark.parametrize(
    ("name", "exact"),
    [("box", 0.024), ("cylinder", np.pi * 0.08**2 * np.hypot(0.1, 0.4)), ("sphere", 4.0 / 3.0 * np.pi * 0.2**3)],
)
def test_volume_and_place(parts: Parts, name: str, exact: float) -> None:
    """Corners are rounded, and what is round has flat sides."""
    ((frame, solid, _),) = fixed(parts, name)
    assert frame == "car"
    assert volume(solid) == pytest.approx(exact, rel=0.03)
    middle = 0.5 * (solid.positions.min(axis=0) + solid.positions.max(axis=0))
    expected = [0.05, 0.6, 0.2] if name == "cylinder" else [0.1, 0.0, 0.0]
    assert middle == pytest.approx(expected, abs=1e-6)


def test_normals_are_unit_and_point_out(parts: Parts) -> None:
    solids_of_all = [s for *_, meshes in (*parts.fixed, *parts.free) for s, _ in meshes]
    assert len(solids_of_all) > 20
    for solid in solids_of_all:
        assert np.abs(np.linalg.norm(solid.normals, axis=1) - 1.0).max() < 1e-6
        a, b, c = (solid.positions[solid.triangles[:, k]] for k in range(3))
        flat = np.cross(b - a, c - a)
        size = np.linalg.norm(flat, axis=1)
        assert size.min() > 0.0
        at = solid.normals[solid.triangles].mean(axis=1)
        assert np.mean(np.einsum("ij,ij->i", flat, at) > 0.0) > 0.98  # small bevels have the normals of what they join


def test_wheels_look_outwards(parts: Parts) -> None:
    """Brakes stand on the inner side of a rim, its nuts and spokes on the outer one."""
    for name, out in (("left wheel", 1.0), ("right wheel", -1.0)):
        found = {look: solid for frame, solid, look in fixed(parts, name) if frame == name.partition(" ")[0]}
        middle = {look: 0.5 * (s.positions[:, 1].min() + s.positions[:, 1].max()) for look, s in found.items()}
        assert middle["plastic"] * out > 0.0 > middle["steel"] * out
        reach = np.hypot(*found["rubber"].positions[:, [0, 2]].T).max()
        assert reach == pytest.approx(0.3, rel=1e-6)
        assert np.ptp(found["rubber"].positions[:, 1]) == pytest.approx(0.2, rel=0.01)


def test_the_mark_of_a_steering_wheel_is_on_top(parts: Parts) -> None:
    red = [s for _, n, meshes in parts.fixed if n == "steering wheel" for s, look in meshes if look.color[0] > 0.5]
    (mark,) = red
    top = np.array([0.6, 0.0, 0.8])  # across the axis, upwards
    assert mark.positions.mean(axis=0) @ top == pytest.approx(0.91 * 0.2, rel=0.02)


def ends_of(name: str) -> tuple[np.ndarray, np.ndarray]:
    given = SHAPES[name]
    a, b = (POSES.points(anchor) for anchor in (given.get("ends") or given["points"]))
    return a, b


@pytest.mark.parametrize(("name", "tolerance"), [("tube", 1e-6), ("spring", 5e-4)])  # a wire has seven sides
def test_what_lies_between_frames_reaches_from_end_to_end(parts: Parts, name: str, tolerance: float) -> None:
    begin, end = ends_of(name)
    motion, solid = next((m, meshes[0][0]) for n, m, meshes in parts.free if n == name)
    low, high = solid.positions[:, 1].min(), solid.positions[:, 1].max()
    for y, exact in ((low, begin), (high, end)):
        made = motion.position + rotated(motion.quaternion, motion.scale * np.array([0.0, y, 0.0]))
        assert np.abs(made - exact).max() < tolerance
    assert np.ptp(np.linalg.norm(end - begin, axis=1)) > 0.05
    assert np.abs(motion.scale[:, [0, 2]] - motion.scale[0, 0]).max() < 1e-12  # only its length changes
    dot = np.abs(np.einsum("ni,ni->n", motion.quaternion[1:], motion.quaternion[:-1])).clip(0.0, 1.0)
    turned = 2.0 * np.arccos(dot)
    y = rotated(motion.quaternion, np.array([0.0, 1.0, 0.0]))
    swung = np.arccos(np.einsum("ni,ni->n", y[1:], y[:-1]).clip(-1.0, 1.0))
    assert np.abs(turned - swung).max() < 1e-6, "it does not twist"


def test_balls_stand_in_the_frames_of_their_ends(parts: Parts) -> None:
    for name in ("tube", "damper"):
        found = {frame: solid.positions.mean(axis=0) for frame, solid, _ in fixed(parts, name)}
        ends = SHAPES[name].get("ends") or SHAPES[name]["points"]
        assert found.keys() == {"car", "left"}
        for frame, place in ends:
            assert found[frame] == pytest.approx(place, abs=1e-6)


def test_rods_of_a_damper_keep_their_length(parts: Parts) -> None:
    begin, end = ends_of("damper")
    rods = [(m, meshes[0]) for n, m, meshes in parts.free if n == "damper"]
    assert sorted(look.name for _, (_, look) in rods) == ["chrome", "dark_paint", "steel"]
    for motion, _ in rods:
        assert np.abs(motion.scale - motion.scale[0]).max() < 1e-9
        along = (end - begin) / np.linalg.norm(end - begin, axis=1)[:, None]
        off = np.cross(motion.position - begin, along)
        assert np.abs(off).max() < 1e-9


def test_a_plate_that_bends_keeps_its_form_and_says_so(parts: Parts) -> None:
    (note,) = parts.notes
    corners = np.stack([POSES.points(anchor) for anchor in MIXED], axis=1)
    apart = np.linalg.norm(corners[:, 2] - corners[:, 0], axis=1)
    least = 1000.0 * np.abs(apart - apart[0]).max()
    told = float(note.split("off by ")[1].split()[0])
    assert note.startswith("The plate 'plate' changes its form; it keeps that of the start, ")
    assert least < told < 1000.0


def test_places_far_away_are_of_double_precision() -> None:
    far = [500_123.456, 5_400_123.4, 112.3]
    boxes = [{"kind": "box", "frame": "ground", "at": far, "size": [1.0, 1.0, 1.0]}]
    boxes.append({"kind": "tube", "points": [["ground", far], ["ground", [*far[:2], 113.3]]], "radius": 0.1})
    made = parts_of({**scene(), "shapes": boxes}, POSES, len(T))
    for (_, _, ((solid, _),)), middle in zip(made.fixed, (far, [*far[:2], 112.8]), strict=True):
        found = 0.5 * (solid.positions.min(axis=0) + solid.positions.max(axis=0))
        assert np.abs(found - middle).max() < 1e-6


def test_solids_are_joined() -> None:
    one = Solid(np.eye(3), np.eye(3), np.array([[0, 1, 2]]))
    two = joined([one, one])
    assert two.triangles.tolist() == [[0, 1, 2], [3, 4, 5]]
    assert joined([one, Solid(np.eye(3), None, one.triangles)]).normals is None


def test_a_program_that_fails_is_one_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    failed = subprocess.CompletedProcess([], 1, b"", b"Error: out of\nmemory")
    monkeypatch.setattr(subprocess, "run", lambda *_, **__: failed)
    monkeypatch.setattr(solids, "bundle", lambda: Path("viewer.js"))
    with pytest.raises(ViewerError, match=r"^A glTF file cannot be written: .* failed \(Error: out of memory\)\.$"):
        parts_of(scene(), POSES, len(T))


def test_a_program_that_does_not_start_is_one_sentence(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(solids, "node", lambda: (str(tmp_path / "node"), ""))
    monkeypatch.setattr(solids, "bundle", lambda: Path("viewer.js"))
    with pytest.raises(ViewerError, match=r"^A glTF file cannot be written: .*node does not start: no such file"):
        parts_of(scene(), POSES, len(T))
