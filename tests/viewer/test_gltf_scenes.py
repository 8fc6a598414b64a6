"""Every scene that has a film as a glTF file: the validator finds nothing, and another reader has its poses."""

import numpy as np
import pytest

from benchmarks.pictures.animations import ANIMATIONS
from tests.viewer.gltf_files import accessor, content, run_node
from tests.viewer.poses import FramePoses, rotated
from viewer.gltf import write_gltf

SCENES = [name for name in ANIMATIONS if name not in ("drop", "proving_ground")]  # the car of the lane change
FEW = ("slider_crank", "bricard")  # in the plane, in space; the others, as cars that bend, in the proof run
CORNERS = np.vstack([np.zeros(3), np.eye(3)])


@pytest.mark.slow
@pytest.mark.parametrize("name", [pytest.param(s, marks=[pytest.mark.proof] * (s not in FEW)) for s in SCENES])
def test_a_scene_is_a_gltf_file(tmp_path, recorded, name):
    film = ANIMATIONS[name]
    recording = recorded(name).between(film.begin, film.end)
    path = tmp_path / f"{name}.glb"
    write_gltf(path, recording, rate=200.0, speed=film.speed)
    assert run_node("validate_gltf.mjs", path)[0]["issues"]["messages"] == []
    animation = content(path)[0]["animations"][0]
    keys = accessor(path, animation["samplers"][0]["input"]).ravel()[:: len(recording.t) // 40 + 1]
    t = (recording.t - recording.t[0]) / film.speed
    looked = np.abs(t[:, None] - keys).argmin(axis=0)
    assert np.abs(t[looked] - keys).max() < 1e-6  # keys are recorded times
    answer = run_node("read_gltf.mjs", path, *t[looked])[0]
    poses = FramePoses(recording.scene, recording.columns, len(t))
    index = {node["name"]: str(k) for k, node in enumerate(content(path)[0]["nodes"])}
    root = np.array(answer[0]["0"]["matrix"]).reshape(4, 4).T
    frames = [frame for frame in recording.scene["frames"] if frame in index]
    assert frames, "no frame has a node"
    reach = max(1.0, max(float(np.abs(poses.of(frame).position).max()) for frame in frames))
    for frame in frames:
        pose = poses.of(frame)
        for row, k in enumerate(looked):
            matrix = np.linalg.inv(root) @ np.array(answer[row][index[frame]]["matrix"]).reshape(4, 4).T
            result = CORNERS @ matrix[:3, :3].T + matrix[:3, 3]
            exact = pose.position[k] + rotated(np.repeat(pose.quaternion[k : k + 1], 4, axis=0), CORNERS)
            assert np.abs(result - exact).max() < 1e-5 * reach
