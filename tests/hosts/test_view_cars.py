"""Results of both cars as `ali3 view` shows them."""

from __future__ import annotations

import io
from pathlib import Path

import fmpy
import numpy as np
import pytest
from PIL import Image

import mbs
from fmu_src.build.build import build_fmu
from hosts.run.command import main as drive
from hosts.view.command import main as view
from hosts.view.recorded import read_table
from mbs.vehicle import load
from tests.hosts.test_view import shown
from viewer.browser import BrowserError, find_chromium
from viewer.poses import FramePoses
from viewer.scene_columns import pose_columns

CARS = ("prototype", "hatchback")
WHEELS = ("FL", "FR", "RL", "RR")


@pytest.fixture(scope="module")
def results(prototype_fmu: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Tables of a double lane change."""
    folder = tmp_path_factory.mktemp("cars")
    made = {}
    hatchback = build_fmu(mbs.compile(load("hatchback").model()), "hatchback", folder, [fmpy.platform])
    for name, fmu, table in zip(CARS, (prototype_fmu, hatchback), ("prototype_car", "hatchback"), strict=True):
        assert drive([str(fmu), "-m", "double_lane_change", "--step", "0.01", "--out", str(folder)]) == 0
        made[name] = folder / f"{table}_double_lane_change.csv"
    return made


@pytest.mark.parametrize("name", CARS)
def test_a_car_is_drawn_whole_with_its_wheels_on_the_road(results: dict[str, Path], name: str, tmp_path: Path) -> None:
    page = tmp_path / f"{results[name].stem}.html"
    assert view([str(results[name]), "--no-open", "--out", str(tmp_path)]) == 0
    (run,) = shown(page)
    assert run["missing"] == []
    assert run["notes"] == []
    table = read_table(results[name])
    for column in pose_columns(run["scene"]):
        np.testing.assert_array_equal(run["columns"][column], table.columns[column])
    poses = FramePoses(run["scene"], run["columns"], len(table.t))
    wheels = {s["frame"]: s for s in run["scene"]["shapes"] if s["kind"] == "wheel"}
    for wheel in WHEELS:
        shape = wheels[f"wheel {wheel}"]
        centre = poses.points([f"wheel {wheel}", shape.get("at", [0.0, 0.0, 0.0])])
        # The lowest point of a drawn wheel touches the level road within the tyre's deflection and the camber.
        assert np.abs(centre[:, 2] - shape["radius"]).max() < 0.06
        # It rolls: its angle is the way over its radius, but for slip and the turns of the lane change.
        way = np.hypot(np.diff(centre[:, 0]), np.diff(centre[:, 1])).sum()
        angle = run["columns"][run["scene"]["frames"][f"wheel {wheel}"]["angle"]]
        assert (angle[-1] - angle[0]) * shape["radius"] == pytest.approx(way, rel=0.1)


@pytest.mark.slow  # two pages are drawn by the processor
def test_both_cars_in_one_picture(results: dict[str, Path], tmp_path: Path) -> None:
    pytest.importorskip("playwright")
    try:
        find_chromium()
    except BrowserError as error:
        pytest.skip(str(error))
    pictures = []
    for names in (CARS[:1], CARS):
        file = tmp_path / f"{len(names)}.png"
        paths = [str(results[name]) for name in names]
        assert view([*paths, "--png", str(file), "--at", "3", "--size", "320", "180"]) == 0
        pictures.append(np.asarray(Image.open(io.BytesIO(file.read_bytes())).convert("RGB")).astype(int))
    alone, both = pictures
    changed = np.abs(alone - both).max(axis=2) > 10
    assert 0.005 < changed.mean() < 0.6  # the ghost, beside the car and over it
