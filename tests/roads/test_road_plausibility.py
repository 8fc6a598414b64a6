"""Implausible roads and worlds are reported with the probable mistake."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mbs.elements.road import GridRoad
from mbs.roads import RoadFileError, read_road
from mbs.roads.road_plausibility import Place, road_plausibility, start_plausibility
from mbs.worlds.make_world import read_world
from mbs.worlds.world_plausibility import world_plausibility
from mbs.worlds.world_types import WorldDescription

ROADS = Path(__file__).parents[2] / "mbs" / "roads" / "files"
WORLD = Path(__file__).parents[2] / "mbs" / "worlds" / "proving_ground.toml"


def waves(step: float = 0.0, factor: float = 1.0, spacing: float = 0.5) -> GridRoad:
    x = np.linspace(0.0, 50.0, 101)
    z = 0.5 * np.sin(0.2 * x)[:, None] + 0.05 * np.cos(np.linspace(0.0, 3.0, 21))
    z = np.round(z / step) * step if step else z
    return GridRoad((0.0, -5.0), (spacing, spacing), factor * z)


def test_roads_of_the_package_have_nothing_odd() -> None:
    for file in sorted(ROADS.glob("*.toml")):
        road = read_road(file)
        if isinstance(road, GridRoad):
            assert road_plausibility(file.name, road).warnings() == []
    assert world_plausibility("world", read_world(WORLD)).warnings() == []


@pytest.mark.parametrize(
    ("road", "message"),
    [
        (waves(factor=1000.0), "mm instead of m in heights"),
        (waves(factor=100.0), "cm instead of m in heights"),
        (replace(waves(), frictions=90.0), "percent instead of a ratio in frictions"),
        (waves(spacing=500.0), "mm instead of m in coordinates or"),
        (waves(step=0.01), "step of the heights is 0.01 m"),
        (waves(step=0.25), "step of the heights is 0.25 m"),
        (GridRoad((0.0, 0.0), (1.0, 1.0), np.zeros((9, 9)), 1.9), "friction is 1.9"),
    ],
)
def test_a_road_in_another_unit(road: GridRoad, message: str) -> None:
    (sentence,) = road_plausibility("odd.csv", road).warnings()[:1]
    assert sentence.startswith("odd.csv: ")
    assert message in sentence


def with_wall(road: GridRoad, height: float) -> GridRoad:
    z = np.array(road.heights)
    z[:, :3] += height
    return replace(road, heights=z)


def with_hole(road: GridRoad, value: float) -> GridRoad:
    z = np.array(road.heights)
    z[40:43, 9] = value
    return replace(road, heights=z)


def test_a_wall_is_reported_without_a_cause() -> None:
    """Heights in another unit would be steep everywhere."""
    (sentence,) = road_plausibility("wall.csv", with_wall(waves(), 2.5)).warnings()
    assert "rise from point to point" in sentence
    assert "would explain" not in sentence


@pytest.mark.parametrize("value", [-9999.0, -99.0, 9999.0])
def test_no_value_is_the_one_cause(value: float) -> None:
    sentence = road_plausibility("holes.csv", with_hole(waves(), value)).warnings()[0]
    assert f"; {value:g} in the place of no value in heights would explain it" in sentence


def test_a_road_drawn_with_few_heights_has_no_coarse_number_type() -> None:
    """The straight of OpenCRG's samples has steps of 1/90 m."""
    z = np.outer(np.array([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 5.0, 4.0, 3.0]), np.ones(4)) / 90.0
    assert road_plausibility("drawn.crg", GridRoad((0.0, 0.0), (1.0, 0.5), z)).warnings() == []


@pytest.mark.parametrize(
    ("origin", "spacing", "message"),
    [
        ((500.0, -5.0), 0.5, "distance of the start from the road is 500 m"),
        ((4.5e5, 5.4e6), 0.5, "coordinates of a map"),
        ((2e4, -5e3), 500.0, "mm instead of m in coordinates"),
        ((-5.0, 300.0), 0.5, "is 300 m"),
    ],
)
def test_a_start_beside_its_road(origin: tuple[float, float], spacing: float, message: str) -> None:
    place = Place(origin, (spacing, spacing), (101, 21))
    (sentence,) = start_plausibility("far.road", place, (0.0, 0.0)).warnings()
    assert message in sentence
    inside = start_plausibility("far.road", place, (origin[0] + spacing, origin[1] + spacing))
    assert "start" not in " ".join(inside.warnings())


def test_heights_in_mm_by_their_first_cell(tmp_path: Path) -> None:
    for corner, right in (("x [mm]", False), ("x (mm)", False), ("mm", False), ("x mm", False), ("x_cm", False),
                          ("x [m]", True), ("x (m)", True), ("x", True), ("x/y", True), ("m", True)):  # fmt: skip
        file = tmp_path / "road.csv"
        file.write_text(f"{corner},0,1,2\n0,0,0,0\n1,0,0,0\n2,0,0,0\n", encoding="utf-8")
        if right:
            read_road(file)
        else:
            with pytest.raises(RoadFileError, match="coordinates and heights must be in m"):
                read_road(file)


KERB: dict[str, Any] = {"kind": "kerb", "at": [10.0, 0.0, 0.0], "length": 2.0, "left": 2.0, "right": -2.0}
THINGS = {
    "exchanged sides": (
        {"obstacles": [KERB | {"left": -2.0, "right": 2.0}]},
        "left and right exchanged in obstacles.0",
    ),
    "mm": ({"obstacles": [KERB | {"at": [1e4, 0.0, 0.0]}]}, "mm instead of m in obstacles.0"),
    "x for y": ({"obstacles": [KERB | {"at": [2.0, 45.0, 0.0]}]}, "x and y exchanged in obstacles.0"),
    "a sign": ({"obstacles": [KERB | {"at": [-30.0, 0.0, 0.0]}]}, "the sign of x in obstacles.0"),
    "between points": (
        {"obstacles": [{"kind": "washboard", "at": [10.02, 0.05, 0.0], "length": 1.0, "width": 0.02,
                        "wavelength": 0.5, "height": 0.1}]},
        "points of the grid that it changes is 0",
    ),
    "a band": ({"bands": [{"at": [5.0, 0.0, 0.0], "length": 4.0, "left": -1.0, "right": 1.0, "surface": "ice"}]},
               "left and right exchanged in bands.0"),
    "an area": ({"areas": [{"name": "a", "at": [500.0, 0.0], "radius": 5.0}]}, "areas.0 points of the grid"),
    "an area in mm": ({"areas": [{"name": "a", "at": [2e4, 0.0], "radius": 5.0}]}, "mm instead of m in areas.0"),
    "a cone": ({"cones": [{"at": [[10.0, 0.0], [1e4, 0.0]]}]}, "cones.0 distance outside of the world is 9950 m"),
    "a sign of a text": ({"signs": [{"at": [0.0, 900.0, 0.0], "text": "stop"}]}, "signs.0 distance outside"),
    "a line": ({"lines": [{"points": [[0.0, 0.0], [0.0, 4000.0]]}]}, "lines.0 distance outside"),
    "a house": ({"buildings": [{"at": [-700.0, 0.0, 0.0], "size": [5.0, 5.0, 5.0]}]}, "buildings.0 distance outside"),
}  # fmt: skip


STRAIGHT = {"name": "lane", "points": [[0.0, 0.0], [45.0, 0.0]], "width": 6.0}
HOUSE = {"at": [20.0, 0.0, 0.0], "size": [5.0, 5.0, 5.0]}
ODD_THINGS = {
    "beside all roads": ({"obstacles": [KERB | {"at": [20.0, 8.0, 0.0]}]}, "obstacles.0 distance beside the nearest"),
    "in a road": ({"buildings": [HOUSE]}, "buildings.0 distance from the edge of the nearest road or area is -3 m"),
    "in an area": ({"buildings": [HOUSE | {"at": [20.0, 7.0, 0.0]}],
                    "areas": [{"name": "pad", "at": [20.0, 7.0], "size": [8.0, 4.0]}]}, "or area is -2 m"),
    "a house in mm": ({"buildings": [HOUSE | {"at": [20.0, 9.0, 0.0], "size": [5e3, 5.0, 5.0]}]}, "side of the build"),
    "a width in ft": ({"courses": [STRAIGHT | {"width": 39.4}]}, "width of the course is 39.4 m"),
    "a shoulder in mm": ({"courses": [STRAIGHT | {"shoulder": 1500.0}]}, "width of the strip beside the road"),
    "an area in the air": ({"areas": [{"name": "a", "at": [20.0, 0.0], "radius": 5.0, "height": 100.0}]},
                           "grade from the ground to the area is 6.667"),
    "an area in mm": ({"areas": [{"name": "a", "at": [20.0, 0.0], "radius": 5e3}]}, "areas.0.size distance outside"),
    "a circle in mm": ({"lines": [{"centre": [20.0, 0.0], "radius": 5e3}]}, "lines.0.radius distance outside"),
    "a slalom in mm": ({"cones": [{"start": [0.0, 0.0, 0.0], "slalom": 9, "distance": 18e3}]},
                       "cones.0.distance distance outside of the world is"),
    "a barrier in km": ({"barriers": [{"course": "lane", "begin": 0.0, "end": 450.0}]}, "that of its course is 10"),
    "a barrier that ends first": ({"barriers": [{"course": "lane", "begin": 30.0, "end": 3.0}]}, "its course is -0.6"),
    "ice like asphalt": ({"frictions": {"ice": 0.9}}, "ice friction over that of the textbook is 9"),
    "trees nowhere": ({"trees": {"count": 9, "distance": 12e3}}, "distance of trees from roads"),
    "twice": ({"obstacles": [KERB, KERB]}, "obstacles things that stand twice is 1"),
    "waves between points": ({"spacing": [1.0, 0.1], "obstacles": [
        {"kind": "washboard", "at": [10.0, 0.0, 0.0], "length": 9.0, "width": 4.0, "wavelength": 0.7, "height": 0.02}]},
        "points over the shortest slope or wave is 0.7"),
    "a spacing in cm": ({"spacing": [5.0, 10.0], "obstacles": [KERB | {"at": [21.0, 0.0, 0.0]}]},
                        "cm instead of m in spacing"),
}  # fmt: skip


@pytest.mark.parametrize("case", ODD_THINGS)
def test_implausible_worlds_are_reported(case: str) -> None:
    more, message = ODD_THINGS[case]
    plain = {"kind": "world", "name": "w", "bounds": [-5.0, -10.0, 50.0, 10.0], "courses": [STRAIGHT]}
    (sentence,) = world_plausibility("w.toml", WorldDescription.model_validate(plain | more)).warnings()
    assert message in sentence


@pytest.mark.parametrize("case", THINGS)
def test_what_is_in_no_world_is_named(case: str) -> None:
    more, message = THINGS[case]
    bounds = [-5.0, -10.0, 50.0, 10.0]
    world = WorldDescription.model_validate({"kind": "world", "name": "w", "bounds": bounds} | more)
    (sentence,) = world_plausibility("w.toml", world).warnings()
    assert message in sentence
