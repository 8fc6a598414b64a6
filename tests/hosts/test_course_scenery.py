"""Cones of a driver's course in the scene: where ISO 3888 has its lanes, on the ground of the road."""

import json
from pathlib import Path

import numpy as np
import pytest

from ali3.cones import cone_places
from ali3.iso_3888 import lanes
from ali3.scene.base64_numbers import encoded
from hosts.common.errors import HostError
from hosts.common.world_files import world_beside
from hosts.driving.course import course_of
from hosts.driving.course_scenery import with_course
from hosts.view.result_record import with_recorded_course
from tests.viewer import hand_world

WIDTH = 1.6
COURSE = course_of("iso_3888_1", WIDTH)
LEVEL = {"kind": "flat", "height": 0.2}


def test_cones_stand_at_the_edges_of_the_lanes_and_at_their_ends() -> None:
    gates = lanes("ISO 3888-1", WIDTH, 15.0)
    places = np.array(cone_places(gates))
    for gate in gates:
        inside = places[(places[:, 0] >= gate.x_start) & (places[:, 0] <= gate.x_end)]
        assert set(inside[:, 1]) == {gate.y_right, gate.y_left}
        assert (inside[:, 0].min(), inside[:, 0].max()) == (gate.x_start, gate.x_end)
    assert len(places) == 2 * (4 + 6 + 7)  # lanes of 15, 25 and 30 m
    assert set(np.round(np.diff(np.unique(places[:, 0])), 9)) == {5.0, 30.0, 25.0}  # and the ways between them


KERB = {"kind": "profile", "stations": [-1.0, 1.0], "heights": [0.0, -0.1], "origin": [50.0, 0.0, 0.0]}


def test_cones_stand_on_a_road_that_falls_along_it() -> None:
    cones = with_course({"roads": [KERB]}, course_of("iso_3888_2", WIDTH))["scenery"]
    assert len(cones) == 2 * 3 * 3  # lanes of 12, 11 and 12 m
    for cone in cones:
        x, _, z = cone["at"]
        assert z == pytest.approx(-0.1 * np.clip((x - 49.0) / 2.0, 0.0, 1.0), abs=1e-12)


def test_each_patch_of_a_terrain_gives_the_heights_within_it_only() -> None:
    """The second one rises by 1 m in 10 m, from the first one's edge on."""
    level, rise = np.zeros((11, 11), "f4"), np.repeat(np.arange(11, dtype="f4")[:, None], 11, axis=1)
    patches = [
        {"origin": [x, -50.0], "spacing": [10.0, 10.0], "shape": [11, 11], "heights": encoded(heights)}
        for x, heights in ((-100.0, level), (0.0, rise))
    ]
    scene = with_course({"roads": [{"kind": "terrain", "patches": patches}]}, course_of("iso_3888_2", WIDTH))
    x, _, z = np.array([cone["at"] for cone in scene["scenery"]]).T
    assert z == pytest.approx(0.1 * x, abs=1e-6)


def test_cones_beyond_a_terrain_are_left_out_with_a_note() -> None:
    """It ends at 120 m, before the end of the third lane."""
    result = with_course(
        {"roads": [hand_world.terrain(-80.0)], "missing": [{"name": "a", "why": "b"}]}, course_of("iso_3888_1", WIDTH)
    )
    assert "scenery" not in result
    assert [item["name"] for item in result["missing"]] == ["a", "cones of ISO 3888-1"]


def test_the_world_of_a_road_file_lies_beside_it(tmp_path: Path) -> None:
    road = tmp_path / "test.road"
    record = {"format": "ALi3 world", "version": 1, "road": "test.road", "roads": [LEVEL], "scenery": []}
    assert world_beside(road) is None
    road.with_suffix(".json").write_text(json.dumps(record))
    assert world_beside(road) == record
    road.with_suffix(".json").write_text(json.dumps(record | {"road": "other.road"}))
    assert world_beside(road) is None  # the record of another road
    road.with_suffix(".json").write_text(json.dumps(record | {"version": 2}))
    with pytest.raises(HostError, match=r"test\.json is not a world of version 1, which this version of ali3 reads"):
        world_beside(road)


def test_the_record_of_a_run_brings_the_cones_of_its_driver(tmp_path: Path) -> None:
    """As `ali3 run` writes it: the track by its name in the standard."""
    record, file = {"course": {"track": COURSE.name, "vehicle_width": WIDTH}}, tmp_path / "run.json"
    assert with_recorded_course({"roads": [LEVEL]}, record, file) == with_course({"roads": [LEVEL]}, COURSE)
    assert with_recorded_course({"roads": [LEVEL]}, {"course": None}, file) == {"roads": [LEVEL]}
    for course in ({"track": "ISO 1"}, {"track": COURSE.name, "vehicle_width": -1.0}, "ISO 3888-1"):
        with pytest.raises(HostError, match="does not say by 'course' a track of ISO 3888 and a vehicle_width"):
            with_recorded_course({"roads": [LEVEL]}, {"course": course}, file)
