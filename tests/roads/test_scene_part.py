"""Roads as entries of a scene: the heights that are drawn are those of the physics."""

import base64
import json
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from ali3.scene.base64_numbers import decoded
from ali3.scene.scene import scene_errors
from mbs.elements import GridRoad, KerbRoad, PlaneRoad
from mbs.roads import write_road
from mbs.roads.scene_part import drawn_roads, scene_part
from mbs.worlds.command import main
from tests.elements.harness import contacts

SCENE = {"format": "ALi3 scene", "version": 1, "name": "roads", "extent": 1.0, "frames": {}, "shapes": []}


def valid(part: dict[str, Any]) -> dict[str, Any]:
    assert scene_errors(SCENE | {"roads": [part]}) == []
    return part


def under(road: object, x: float, y: float) -> float:
    """Height by a disc that touches the road there."""
    z = 10.0
    for _ in range(30):
        z = float(contacts(road, [x, y, z], [0.0, 1.0, 0.0], 1e-9)[0]["point"][2])  # type: ignore[arg-type]
    return z


def test_level_and_inclined_planes():
    assert valid(scene_part(PlaneRoad(0.3))) == {"kind": "flat", "height": 0.3, "friction": 0.9}
    road = PlaneRoad(0.3, 0.08, -0.05)
    part = valid(scene_part(road))
    point, normal = np.array(part["point"]), np.array(part["normal"])
    for x, y in ((3.0, 4.0), (-2.0, 7.0)):
        assert normal @ (np.array([x, y, under(road, x, y)]) - point) == pytest.approx(0.0, abs=1e-9)
    assert normal[2] > 0.0


@pytest.mark.parametrize(
    "road",
    [
        PlaneRoad(0.3, friction=0.1),
        PlaneRoad(0.3, 0.05, friction=0.1),
        KerbRoad(7.5, 0.08, -0.08, "after", 0.1),
        GridRoad((0.0, 0.0), (1.0, 1.0), np.zeros((3, 3)), 0.1),
    ],
)
def test_a_uniform_road_reports_its_friction_and_factor(road):
    assert valid(scene_part(road))["friction"] == 0.1
    dry = replace(road, frictions=1.2) if isinstance(road, GridRoad) else replace(road, friction=1.2)
    halved = valid(scene_part(replace(dry, friction_factor=0.5)))
    assert (halved["friction"], halved["friction_factor"]) == (1.2, 0.5)


@pytest.mark.parametrize(("upper", "heights"), [("before", [0.0, -0.08]), ("after", [-0.08, 0.0])])
def test_a_kerb_is_a_step_where_it_is(upper, heights):
    part = valid(scene_part(KerbRoad(7.5, 0.08, -0.08, upper)))  # type: ignore[arg-type]
    assert part["heights"] == heights
    assert part["origin"] == [7.5, 0.0, 0.0]
    assert part["stations"][0] < 0.0 < part["stations"][1]


def test_two_frictions_are_drawn_as_far_as_a_car_is_wide_and_farther():
    """The values of the border go on in the physics; the strip in which they change is 0.3 m wide."""
    road = GridRoad((-20.0, -0.15), (400.0, 0.1), np.zeros((2, 4)), np.tile([0.2, 0.2, 1.0, 1.0], (2, 1)))
    part = valid(scene_part(road))
    y = part["origin"][1] + part["spacing"][1] * np.arange(part["shape"][1])
    frictions = decoded(part["frictions"], "f").reshape(part["shape"])
    assert part["origin"][0] == -20.0
    assert y.min() <= -10.0
    assert y.max() >= 10.0
    assert np.allclose(frictions, np.where(y > 0.0, 1.0, 0.2))


def grid(nx: int, ny: int) -> GridRoad:
    x, y = np.meshgrid(np.arange(nx) * 0.5 - 3.0, np.arange(ny) * 0.25 + 2.0, indexing="ij")
    return GridRoad((-3.0, 2.0), (0.5, 0.25), 0.01 * x + 0.02 * y + 0.001 * x * y, 0.5 + 0.001 * x)


def test_a_grid_keeps_its_points():
    road = grid(7, 9)
    part = valid(scene_part(road))
    assert part["shape"] == [7, 9]
    assert "note" not in part
    heights = np.frombuffer(base64.b64decode(part["heights"]), "<f4").reshape(7, 9)
    for i, j in ((0, 0), (3, 4), (6, 8)):
        x, y = (part["origin"][k] + n * part["spacing"][k] for k, n in enumerate((i, j)))
        assert heights[i, j] == pytest.approx(under(road, x, y), abs=1e-6)
    frictions = np.frombuffer(base64.b64decode(part["frictions"]), "<f4")
    assert np.allclose(frictions.reshape(7, 9), road.frictions)


def test_a_large_grid_is_thinned_and_reported():
    road = grid(1001, 90)
    part = valid(scene_part(road))
    assert part["shape"] == [334, 90]
    assert part["spacing"] == [1.5, 0.25]
    assert part["note"] == "the road has 1001 x 90 points; 334 x 90 of them are drawn"
    heights = np.frombuffer(base64.b64decode(part["heights"]), "<f4").reshape(334, 90)
    assert np.allclose(heights, np.asarray(road.heights)[::3], atol=1e-6)


def test_the_command_writes_the_result_of_the_function(tmp_path, capsys):
    road, file, out = grid(20, 30), tmp_path / "a.road", tmp_path / "a.json"
    write_road(road, file)
    assert main([str(file), "--part", str(out)]) == 0
    assert f"written: {out}" in capsys.readouterr().out
    part = json.loads(out.read_text(encoding="utf-8"))
    assert valid(part)["shape"] == [20, 30]
    assert drawn_roads([{"kind": "file", "path": str(file)}, {"kind": "flat", "height": 1.0}]) == [
        part,
        {"kind": "flat", "height": 1.0},
    ]
