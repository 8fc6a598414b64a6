"""Poses of frames from columns: against closed forms and against the page's own code."""

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.viewer import moving_car
from tests.viewer.poses import FramePoses
from viewer import page_build

PAGE = Path(page_build.__file__).parent / "page"
FRAMES = ("chassis", "carrier", "wheel", "arm", "rack")
SLIDING = {"parent": "chassis", "at": [0.1, 0.2, 0.3], "direction": [0.0, 0.6, 0.8], "way": "rack"}
T = np.linspace(0.0, 3.0, 61)


@pytest.fixture
def recording():
    """With a rack that slides on the chassis."""
    result = moving_car.recording(T)
    result.scene["frames"]["rack"] = SLIDING
    result.columns["rack"] = 0.2 * np.sin(T)
    return result


def exact(name):
    if name != "rack":
        return moving_car.pose(name, T)
    position, rotation = moving_car.pose("chassis", T)
    slid = np.outer(0.2 * np.sin(T), SLIDING["direction"])
    return position + rotation.apply(slid + SLIDING["at"]), rotation


def test_every_kind_of_frame_is_where_it_was(recording):
    poses = FramePoses(recording.scene, recording.columns, len(T))
    for name in FRAMES:
        result = poses.of(name)
        position, rotation = exact(name)
        assert np.abs(result.position - position).max() < 1e-12, name
        turn = rotation.inv() * Rotation.from_quat(result.quaternion, scalar_first=True)
        assert turn.magnitude().max() < 1e-7, name


def test_the_page_has_the_same_poses(recording):
    found = FramePoses(recording.scene, recording.columns, len(T))
    rows = [{name: values[k] for name, values in recording.columns.items()} for k in range(len(T))]
    try:
        node = page_build.node_and_npm()[0]
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
