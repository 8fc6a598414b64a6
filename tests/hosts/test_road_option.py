"""The option ``--road`` of hosts, and worlds that they build by the command."""

import json
from pathlib import Path

import fmpy
import numpy as np
import pytest

import mbs
from fmu_src.build.build import build_fmu
from hosts.common.errors import HostError
from hosts.common.road import report_starts, road_value
from hosts.common.world_files import make_world
from hosts.run.command import main
from mbs.elements import ContactPoints, PlaneRoad

TABLE = "x,-5,0,5\n-50,{0},{0},{0}\n0,{0},{0},{0}\n50,{0},{0},{0}\n"


@pytest.fixture(scope="module")
def sledge(tmp_path_factory):
    m = mbs.Model("sledge", gravity=(0.0, 0.0, -9.81))
    m.floating = m.start_in_equilibrium = True
    m.stop_time, m.step = 0.2, 0.002
    body = m.body("sledge", mass=20.0, com=(0.0, 0.0, 0.2), inertia=(1.0, 2.0, 2.0))
    road = m.road(PlaneRoad(friction=0.5), file="road.file")
    feet = [(x, y, 0.0) for x in (-0.5, 0.5) for y in (-0.2, 0.2)]
    m.contact_points("feet", body, feet, road=road, contact=ContactPoints.for_mass(20.0, 0.001))
    m.sense_position("z", body, None, "z")
    return build_fmu(mbs.compile(m), "sledge", tmp_path_factory.mktemp("sledge"), [fmpy.platform])


@pytest.mark.slow
def test_what_the_parameter_is_set_to(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert road_value("rough.road", tmp_path) == "rough.road"  # of the FMU
    Path("rough.road").touch()
    assert road_value("rough.road", tmp_path) == str(tmp_path / "rough.road")
    Path("hill.csv").write_text(TABLE.format(2.0))
    result = road_value("hill.csv", tmp_path / "out")
    assert result == str(tmp_path / "out" / "hill.road")
    assert np.all(np.asarray(mbs.read_road(result).heights) == 2.0)
    Path("bad.csv").write_text("1,2\n")
    with pytest.raises(HostError, match=r"^bad.csv has 1 rows; a grid needs at least two\.$"):
        road_value("bad.csv", tmp_path / "out")


@pytest.mark.slow
def test_a_run_on_a_table(sledge, tmp_path, capsys):
    (tmp_path / "hill.csv").write_text(TABLE.format(3.0))
    out = tmp_path / "out"
    assert main([str(sledge), "--road", str(tmp_path / "hill.csv"), "--out", str(out)]) == 0
    assert "'' -> " in capsys.readouterr().out
    table = np.genfromtxt(out / f"{sledge.stem.lower()}.csv", delimiter=",", names=True)
    assert table["z"][-1] == pytest.approx(3.2, abs=0.01)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("x", "start", "message"),
    [
        (0.0, 0.0, ""),
        (550.0, 0.0, "distance of the start from the road is 500 m"),
        (4.5e5, 0.0, "coordinates of a map"),
    ],
)
def test_a_start_beside_the_road_is_reported_before_the_drive(tmp_path, capfd, x, start, message):
    rows = "".join(f"{x + at:g},0,0,0\n" for at in (-50.0, 0.0, 50.0))
    (tmp_path / "far.csv").write_text(f"x,-5,0,5\n{rows}")
    road = road_value(str(tmp_path / "far.csv"), tmp_path)
    report_starts([{"road.file": road, "initial.x": start}] * 3)
    errors = capfd.readouterr().err
    assert errors.count("warning: ") == bool(message)
    assert message in errors


def test_a_road_that_is_not_there(sledge, tmp_path, capsys):
    assert main([str(sledge), "--road", "nothing.road", "--out", str(tmp_path)]) == 2
    assert "'road.file' cannot be 'nothing.road'" in capsys.readouterr().err


WORLD = 'kind = "world"\nname = "{name}"\nbounds = [-20.0, -20.0, 20.0, 20.0]\nspacing = [1.0, 1.0]\n'
STEEP = '[[courses]]\nname = "hill"\npoints = "hill.csv"\nsmoothing = 1.0\nwidth = 3.0\nblend = 5.0\n'


@pytest.mark.slow
def test_a_description_has_its_own_name_and_warnings_of_the_command_are_reported(tmp_path, monkeypatch):
    monkeypatch.setenv("ALI3_CACHE", str(tmp_path / "cache"))
    file = tmp_path / "other.toml"
    rows = "".join(f"{x},0,{0.6 * (x + 15):.3f}\n" for x in range(-15, 16, 3))
    (tmp_path / "hill.csv").write_text("# x, y, z\n" + rows, encoding="utf-8")
    for name in ("mini", "maxi"):
        file.write_text(WORLD.format(name=name) + STEEP, encoding="utf-8")
        lines: list[str] = []
        world = make_world(str(file), lines.append)
        assert world.name == name
        assert world.road is not None
        assert json.loads(world.road.with_suffix(".json").read_text(encoding="utf-8"))["name"] == name
        assert [line.partition(" at ")[0] for line in lines if "warning" in line] == [
            "warning: The course 'hill' climbs by 60 %"
        ]
    file.write_text('kind = "world"\nname = "mini"\nbounds = [0.0, 0.0, 0.0, 0.0]\n', encoding="utf-8")
    lines = []
    with pytest.raises(HostError, match="bounds are"):
        make_world(str(file), lines.append)
    assert not lines
