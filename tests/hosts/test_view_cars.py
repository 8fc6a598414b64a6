"""Results of both cars as `ali3 view` shows them."""

import io
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from fmpy import platform
from PIL import Image

import mbs
from ali3.scene.scene_columns import pose_columns
from fmu_src.build.build import build_fmu
from hosts.run.command import main as run
from hosts.view.command import main as view
from hosts.view.result_tables import read_table
from mbs.vehicle import load
from tests.hosts.test_view import shown
from tests.quick import quick
from tests.viewer.poses import FramePoses
from viewer.browser import BrowserError, find_chromium

CARS = ("prototype", "hatchback")
WHEELS = ("FL", "FR", "RL", "RR")


@pytest.fixture(scope="module")
def result_of(prototype_fmu: Path, tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    """The table of a double lane change of a car."""

    def drive(name: str) -> Path:
        folder, fmu = tmp_path_factory.mktemp(name), prototype_fmu
        if name != "prototype":
            fmu = build_fmu(mbs.compile(load(name).model()), name, folder, [platform])
        assert run([str(fmu), "-m", "double_lane_change", "--step", "0.01", "--out", str(folder)]) == 0
        (table,) = folder.glob("*_double_lane_change.csv")
        return table

    return cache(drive)


@pytest.mark.parametrize("name", quick(CARS[:1], CARS))
def test_a_car_is_drawn_whole_with_its_wheels_on_the_road(
    result_of: Callable[[str], Path], name: str, tmp_path: Path
) -> None:
    result = result_of(name)
    page = tmp_path / f"{result.stem}.html"
    assert view([str(result), "--no-open", "--out", str(tmp_path)]) == 0
    (drawn,) = shown(page)
    assert drawn["missing"] == []
    assert drawn["notes"] == []
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
def test_both_cars_in_one_picture(result_of: Callable[[str], Path], tmp_path: Path) -> None:
    pytest.importorskip("playwright")
    try:
        find_chromium()
    except BrowserError as error:
        pytest.skip(str(error))
    pictures = []
    for names in (CARS[:1], CARS):
        file = tmp_path / f"{len(names)}.png"
        paths = [str(result_of(name)) for name in names]
        assert view([*paths, "--png", str(file), "--at", "3", "--size", "320", "180"]) == 0
        pictures.append(np.asarray(Image.open(io.BytesIO(file.read_bytes())).convert("RGB")).astype(int))
    alone, both = pictures
    changed = np.abs(alone - both).max(axis=2) > 10
    assert 0.005 < changed.mean() < 0.6  # the ghost, beside the car and over it
