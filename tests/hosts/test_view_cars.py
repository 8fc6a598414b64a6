"""Results of a car as `ali3 view` shows them."""

import io
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from ali3.scene.scene_columns import pose_columns
from hosts.run.command import main as run
from hosts.view.command import main as view
from hosts.view.result_tables import read_table
from tests.hosts.test_view import shown
from tests.in_browser import chromium_or_skip
from tests.viewer.poses import FramePoses

WHEELS = ("FL", "FR", "RL", "RR")


def driven(fmu: Path, folder: Path, *more: str) -> Path:
    """The table of a double lane change."""
    command = ["-m", "double_lane_change", "--step", "0.01", "--out", str(folder)]
    assert run([str(fmu), *command, *more]) == 0
    (table,) = folder.glob("*_double_lane_change.csv")
    return table


@pytest.mark.slow
def test_a_car_is_drawn_whole_with_its_wheels_on_the_road(prototype_fmu: Path, tmp_path: Path) -> None:
    result = driven(prototype_fmu, tmp_path, "--stop-time", "5", "--set", "front.tyre.grip=0.99")
    page = tmp_path / f"{result.stem}.html"
    assert view([str(result), "--no-open", "--out", str(tmp_path)]) == 0
    (drawn,) = shown(page)
    assert drawn["missing"] == []
    assert drawn["notes"] == []
    assert drawn["constants"]["front.tyre.grip"] == 0.99, "the page colours tyres by their used friction"
    assert 0.5 < drawn["constants"]["vehicle.tyre_friction_front"] < 2.0
    table = read_table(result)
    for column in pose_columns(drawn["scene"]):
        np.testing.assert_array_equal(drawn["columns"][column], table.columns[column])
    poses = FramePoses(drawn["scene"], drawn["columns"], len(table.t))
    wheels = {s["frame"]: s for s in drawn["scene"]["shapes"] if s["kind"] == "wheel"}
    for wheel in WHEELS:
        shape = wheels[f"wheel {wheel}"]
        centre = poses.points([f"wheel {wheel}", shape.get("at", [0.0, 0.0, 0.0])])
        # The lowest point of a drawn wheel touches the level road within the tyre's deflection and the camber.
        assert np.abs(centre[:, 2] - shape["radius"]).max() < 0.06
        # It rolls: its angle is the way over its radius, but for slip and the turns of the lane change.
        distance = np.hypot(np.diff(centre[:, 0]), np.diff(centre[:, 1])).sum()
        angle = drawn["columns"][drawn["scene"]["frames"][f"wheel {wheel}"]["angle"]]
        assert (angle[-1] - angle[0]) * shape["radius"] == pytest.approx(distance, rel=0.1)


@pytest.mark.slow  # two pages are drawn by the processor
def test_two_cars_in_one_picture(prototype_fmu: Path, tmp_path: Path) -> None:
    pytest.importorskip("playwright")
    chromium_or_skip()
    tables = [
        driven(prototype_fmu, tmp_path / name, "--stop-time", "0.5", "--set", f"initial.y={y}")
        for name, y in (("one", 0.0), ("other", 3.0))
    ]
    pictures = []
    for shown_tables in (tables[:1], tables):
        file = tmp_path / f"{len(shown_tables)}.png"
        assert view([*map(str, shown_tables), "--png", str(file), "--at", "0.3", "--size", "320", "180"]) == 0
        pictures.append(np.asarray(Image.open(io.BytesIO(file.read_bytes())).convert("RGB")).astype(int))
    alone, both = pictures
    changed = np.abs(alone - both).max(axis=2) > 10
    assert 0.005 < changed.mean() < 0.6  # the ghost, beside the car and over it
