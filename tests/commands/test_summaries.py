"""Summaries of the results of readers, all by one mechanism."""

import json
from pathlib import Path

import numpy as np
import pytest

import mbs
from ali3.plausibility import Plausibility, Summarised, Value, plausibility_of, quantities_of
from ali3.plausibility.quantity import _ranges
from mbs.elements.road import GridRoad, KerbRoad, PlaneRoad
from mbs.model import Model
from mbs.roads import RoadFile, RoadWarning, read_road, write_road
from mbs.simulation.state import Pose
from mbs.tyre_files import read_tyre
from mbs.urdf import read_urdf
from mbs.vehicle import load
from mbs.vehicle.command import main as car_command
from mbs.vehicle.picture import named_points
from mbs.worlds.command import main as road_command
from mbs.worlds.make_world import read_world

PACKAGE = Path(mbs.__file__).parent
LEVEL = GridRoad((-50.0, -50.0), (10.0, 10.0), np.zeros((11, 11)))
URDF = """<robot name="arm"><link name="base"/><link name="arm"><inertial><origin xyz="0 0 0.3"/><mass value="4"/>
<inertia ixx="0.1" iyy="0.1" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link><joint name="j" type="continuous">
<parent link="base"/><child link="arm"/><origin xyz="0 0 0.5"/><axis xyz="0 1 0"/></joint></robot>"""


def sledge(road: GridRoad | RoadFile) -> mbs.System:
    """Something that can be placed on a road."""
    m = Model("sledge", gravity=(0.0, 0.0, -9.81))
    m.floating = True
    m.body("sledge", mass=20.0, com=(0.0, 0.0, 0.2), inertia=(1.0, 2.0, 2.0))
    m.road(road, file="road.file" if isinstance(road, RoadFile) else None)
    return mbs.compile(m)


@pytest.mark.slow
def test_what_readers_return_sums_itself_up(tmp_path: Path) -> None:
    write_road(LEVEL, tmp_path / "level.road")
    (tmp_path / "arm.urdf").write_text(URDF)
    tyre = next((PACKAGE / "vehicle" / "cars").rglob("*.tir"))
    for thing, message in (
        (read_road(tmp_path / "level.road"), "x 100, y 100 m"),
        (RoadFile(tmp_path / "level.road"), "distance of the start from the road"),
        (PlaneRoad(grade_x=0.03, grade_y=0.04), "0.05"),
        (KerbRoad(3.0, 0.08), "0.08 m"),
        (read_world(PACKAGE / "worlds" / "proving_ground.toml"), "extent of the world"),
        (read_tyre(tyre), "lateral peak friction"),
        (read_urdf(tmp_path / "arm.urdf"), "total mass"),
        (load("prototype"), "flexible frame"),
    ):
        assert isinstance(thing, Summarised)
        assert message in thing.summary()
        assert len(thing.summary().splitlines()) < 60
        assert plausibility_of(thing)
    with pytest.raises(TypeError, match="no summary for a int"):
        plausibility_of(3)


def test_an_open_end_of_a_range_is_null() -> None:
    """JSON has no infinity (RFC 8259)."""
    beside = quantities_of("world")["beside"]
    (row,) = json.loads(json.dumps(Plausibility("", [Value(beside, 5.0, {})]).to_json(), allow_nan=False))
    assert row["range"] == [None, 3.0]
    assert not row["inside"]


def test_the_road_command_writes_its_table(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write_road(LEVEL, tmp_path / "level.road")
    road, table = str(tmp_path / "level.road"), tmp_path / "level.json"
    for more in ([], ["--start", "300", "0"]):
        assert road_command([road, "--json", str(table), *more]) == 0
        captured = capsys.readouterr()
        rows = {(row["name"], row["of"]): row for row in json.loads(table.read_text())["road"]}
        assert rows["extent", "x"]["value"] == 100.0
        away = rows["distance of the start from the road", ""]
        assert (away["value"], away["inside"]) == ((250.0, False) if more else (0.0, True))
        assert ("distance of the start from the road is 250 m" in captured.err) == bool(more)
        assert "usual" in captured.out


def test_a_kind_in_the_table_of_quantities_may_have_two_words() -> None:
    assert _ranges("light truck 1.5 2, van 1 2") == {"light truck": (1.5, 2.0), "van": (1.0, 2.0)}


@pytest.mark.parametrize("of_file", [False, True])
def test_a_simulation_reports_a_start_beside_its_road(tmp_path: Path, of_file: bool) -> None:
    write_road(LEVEL, tmp_path / "level.road")
    system = sledge(RoadFile(tmp_path / "level.road") if of_file else LEVEL)
    mbs.Simulation(system, pose=Pose(x=90.0))
    with pytest.warns(RoadWarning, match="distance of the start from the road is 250 m"):
        mbs.Simulation(system, pose=Pose(x=300.0))


@pytest.mark.slow
def test_the_picture_of_a_car_has_all_points_of_its_file(tmp_path: Path) -> None:
    assert car_command(["saloon", "--picture", str(tmp_path / "saloon.png")]) == 0
    assert (tmp_path / "saloon.png").read_bytes().startswith(b"\x89PNG")
    points = named_points(load("saloon"))
    assert points["front.wheel.centre"] == (0.0, 0.6934, 0.28602)
    contact = load("saloon").chassis.ground_contact
    assert contact is not None
    assert sum("ground_contact" in key for key in points) == len(contact.points)
    assert not any("inertia" in key for key in points)
