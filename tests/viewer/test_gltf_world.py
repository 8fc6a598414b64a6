"""Surroundings, cones and paths in glTF files, as another reader finds them."""

import numpy as np
import pytest
import trimesh

from ali3.scene.recording import Recording
from tests.viewer.gltf_files import TO_EARTH, run_node
from tests.viewer.hand_scenes import moving
from tests.viewer.hand_world import LANES, height, scenery, terrain
from viewer.gltf import write_gltf

T = np.linspace(0.0, 4.0, 81)
RADIUS = 0.3  # m
SPEED = 10.0  # m/s


def run(**parts):
    """A body that goes along x at y = -2 m, 0.5 m above the ground, on a wheel."""
    frames = {
        "body": moving("body"),
        "wheel": {"parent": "body", "at": [0.0, 0.25, RADIUS - 0.5], "axis": [0.0, 1.0, 0.0], "angle": "turn"},
    }
    shapes = [{"kind": "wheel", "frame": "wheel", "radius": RADIUS, "width": 0.2}]
    scene = {"format": "ALi3 scene", "version": 1, "name": "run", "up": [0, 0, 1], "planar": False, "extent": 2.0}
    scene |= {"focus": "body", "frames": frames, "shapes": shapes, "roads": [terrain()], "scenery": scenery()} | parts
    values = [SPEED * T, 0 * T - 2.0, 0 * T + 0.5, 0 * T + 1.0, 0 * T, 0 * T, 0 * T]
    names = [f"body.{part}" for part in ("x", "y", "z", "qw", "qx", "qy", "qz")]
    return Recording(scene, T, dict(zip(names, values, strict=True)) | {"turn": SPEED * T / RADIUS}, name="run")


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    path = tmp_path_factory.mktemp("world") / "run.glb"
    return write_gltf(path, run())


def geometry(path, name):
    """Earth meshes of a node, by material."""
    scene = trimesh.load_scene(path)
    results = {}
    for node in scene.graph.nodes_geometry:
        if node == name or node.startswith(f"{name}_"):
            matrix, key = scene.graph[node]
            mesh = scene.geometry[key].copy()
            mesh.remove_unreferenced_vertices()
            mesh.apply_transform(matrix)
            mesh.vertices = mesh.vertices @ TO_EARTH.T
            results[mesh.visual.material.name, str(mesh.visual.material.baseColorFactor)] = mesh
    return results


def parts(path, name):
    return list(geometry(path, name).values())


@pytest.mark.slow
def test_the_file_is_valid(written):
    assert run_node("validate_gltf.mjs", written.path)[0]["issues"]["messages"] == []


def test_the_ground_has_its_heights_and_surfaces(written):
    result = geometry(written.path, "terrain")
    assert {"asphalt", "grass", "wet", "ice"} <= {name for name, _ in result}
    stated = float(next(note for note in written.notes if "heights are up to" in note).split("up to ")[1].split()[0])
    seen = 0
    for (name, _), mesh in result.items():
        middles = mesh.triangles_center
        assert (mesh.face_normals[:, 2] > 0).all(), "it faces up"
        if name in LANES:
            at = np.abs(middles[:, :2] - [20.0, LANES[name]]).max(axis=1)
            seen += int(at.min() < 0.6)
        x, y, z = mesh.vertices.T
        assert np.abs(z - height(x, y)).max() < 1e-4 + 1e-3 * stated
    assert seen == len(LANES)


def test_cones_and_lines_stand_where_they_are(written):
    cones = np.vstack([mesh.vertices for mesh in parts(written.path, "cone")])
    places = [thing["at"] for thing in scenery() if thing["kind"] == "cone"]
    assert len(places) == 4
    for place in places:
        near = cones[np.linalg.norm(cones[:, :2] - place[:2], axis=1) < 0.3]
        assert near[:, 2].max() == pytest.approx(0.5, abs=1e-6)
        assert near[:, :2].mean(axis=0) == pytest.approx(place[:2], abs=1e-3)
    others = np.linalg.norm(cones[:, None, :2] - np.array(places)[None, :, :2], axis=2).min(axis=1)
    assert others.max() < 0.3, "there are no cones elsewhere"
    lines = np.vstack([mesh.vertices for mesh in parts(written.path, "line")])
    assert {-6.0, 3.0, 0.0} == {round(float(y)) for y in lines[:, 1]}


def test_buildings_stand_in_their_sizes_and_face_outwards(written):
    (mesh,) = parts(written.path, "building")
    for thing in (thing for thing in scenery() if thing["kind"] == "building"):
        length, width, height = thing["size"]
        c, s = np.cos(thing["yaw"]), np.sin(thing["yaw"])
        turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        near = np.linalg.norm(mesh.triangles_center[:, :2] - thing["at"][:2], axis=1) < length
        local = (mesh.triangles[near] - thing["at"]) @ turn
        assert np.abs(local).max(axis=(0, 1)) == pytest.approx(
            [0.5 * length + 0.3, 0.5 * width + 0.4, height], abs=1e-4
        )
        out = local.mean(axis=1) - [0.0, 0.0, 0.4 * height]
        assert (np.einsum("ij,ij->i", mesh.face_normals[near] @ turn, out) > 0.0).all()


def test_paths_lie_where_the_run_has_been(written):
    (body,) = parts(written.path, "path")
    assert body.vertices[:, 0].min() == pytest.approx(0.0, abs=0.05)
    assert body.vertices[:, 0].max() == pytest.approx(SPEED * T[-1], abs=0.05)
    assert np.ptp(body.vertices[:, 1]) == pytest.approx(0.06, abs=1e-6)
    assert body.vertices[:, 1].mean() == pytest.approx(-2.0, abs=1e-6)
    assert body.vertices[:, 2] == pytest.approx(0.05 + height(*body.vertices.T[:2]), abs=1e-4)
    assert (body.face_normals[:, 2] > 0.99).all()
    (wheel,) = parts(written.path, "path wheel")
    assert wheel.vertices[:, 1].mean() == pytest.approx(-1.75, abs=1e-6)


def test_paths_end_at_a_reset(tmp_path):
    """Half-way the body is put 40 m aside."""
    recording = run(roads=[], scenery=[])
    recording.columns["body.y"] = np.where(T > 2.0, 38.0, -2.0)
    recording.epoch = np.where(T > 2.0, 1.0, 0.0)
    path = write_gltf(tmp_path / "reset.glb", recording).path
    for name in ("path", "path wheel"):
        (band,) = parts(path, name)
        assert np.ptp(band.triangles[..., 1], axis=1).max() < 1.0
        assert band.vertices[:, 1].min() < -1.5 < 38.0 < band.vertices[:, 1].max()


def test_omitted_parts_are_reported(written, tmp_path):
    notes = " ".join(written.notes)
    assert "things of the scenery are left out" in notes
    assert "within 60 m of the way" in notes
    bare = write_gltf(tmp_path / "bare.glb", run(), road=False)
    assert parts(bare.path, "cone") == parts(bare.path, "path") == []
