"""Poses of frames from columns: against closed forms, against the page's own code, and where numbers are missing."""

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.viewer import moving_car
from tests.viewer.poses import FramePoses, from_matrices
from viewer import page_build

PAGE = Path(page_build.__file__).parent / "page"
FRAMES = ("chassis", "carrier", "wheel", "arm")
SLIDING = {"parent": "chassis", "at": [0.1, 0.2, 0.3], "direction": [0.0, 0.6, 0.8], "way": "rack"}
T = np.linspace(0.0, 3.0, 61)


def poses(recording):
    return FramePoses(recording.scene, recording.columns, len(recording.t))


@pytest.mark.parametrize("name", FRAMES)
def test_every_kind_of_frame_is_where_it_was(name):
    result = poses(moving_car.recording(T)).of(name)
    position, rotation = moving_car.pose(name, T)
    assert np.abs(result.position - position).max() < 1e-12
    assert (rotation.inv() * Rotation.from_quat(result.quaternion[:, [1, 2, 3, 0]])).magnitude().max() < 1e-7
    assert result.shown.all()
    if name != "wheel":  # it turns by 15 rad between two times
        assert np.einsum("ni,ni->n", result.quaternion[1:], result.quaternion[:-1]).min() > 0.9


def test_the_page_has_the_same_poses():
    recording = moving_car.recording(T)
    found = poses(recording)
    rows = [{name: values[k] for name, values in recording.columns.items()} for k in range(len(T))]
    try:
        node = page_build.node()[0]
    except RuntimeError as error:
        pytest.skip(str(error))
    result = subprocess.run(
        [node, str(PAGE / "test" / "poses.mjs")],
        input=json.dumps([recording.scene, rows]),
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=True,
    )
    for k, row in enumerate(json.loads(result.stdout)):
        for name in FRAMES:
            mine = found.of(name)
            assert np.abs(np.array(row[name]["position"]) - mine.position[k]).max() < 1e-12
            other = np.array(row[name]["quaternion"])
            assert np.abs(other * np.sign(other @ mine.quaternion[k]) - mine.quaternion[k]).max() < 1e-9


def test_a_sliding_frame_moves_along_a_direction_of_its_parent():
    recording = moving_car.recording(T)
    travel = 0.2 * np.sin(T)
    scene = recording.scene | {"frames": recording.scene["frames"] | {"rack": SLIDING}}
    poses = FramePoses(scene, recording.columns | {"rack": travel}, len(T))
    position, rotation = moving_car.pose("chassis", T)
    exact = position + rotation.apply(np.array([0.1, 0.2, 0.3]) + travel[:, None] * [0.0, 0.6, 0.8])
    assert np.abs(poses.of("rack").position - exact).max() < 1e-12
    assert np.abs(poses.of("rack").quaternion - poses.of("chassis").quaternion).max() < 1e-15


def test_a_pose_without_numbers_is_the_one_before_it():
    recording = moving_car.recording(T)
    gap = slice(20, 25)
    recording.columns["carrier.x"] = recording.columns["carrier.x"].copy()
    recording.columns["carrier.x"][gap] = np.nan
    recording.columns["carrier.x"][:3] = np.nan
    actual = poses(recording)
    for name in ("carrier", "wheel", "arm"):
        shown = actual.of(name).shown
        assert np.flatnonzero(~shown).tolist() == [0, 1, 2, 20, 21, 22, 23, 24]
        assert (actual.of(name).position[gap] == actual.of(name).position[19]).all()
        assert (actual.of(name).position[:3] == actual.of(name).position[3]).all()
    assert actual.of("chassis").shown.all()


def test_an_angle_without_a_number_is_that_before_it():
    recording = moving_car.recording(T)
    name = recording.scene["frames"]["wheel"]["angle"]
    recording.columns[name] = recording.columns[name].copy()
    recording.columns[name][10:13] = np.nan
    wheel = poses(recording).of("wheel")
    assert np.flatnonzero(~wheel.shown).tolist() == [10, 11, 12]
    assert (wheel.quaternion[10:13] == wheel.quaternion[9]).all()


def test_quaternions_of_matrices():
    rotations = Rotation.random(500, random_state=3)
    half_turns = Rotation.from_rotvec(np.pi * np.vstack([np.eye(3), [[0.6, 0.8, 0.0], [0.0, 0.6, -0.8]]]))
    for rotation in (rotations, half_turns, Rotation.identity(2)):
        result = from_matrices(rotation.as_matrix())
        assert (rotation.inv() * Rotation.from_quat(np.roll(result, -1, axis=1))).magnitude().max() < 1e-7
