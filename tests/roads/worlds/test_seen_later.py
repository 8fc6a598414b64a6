"""Tables of runs in a world, opened later: its ground and scenery, or a note on what is not drawn."""

import shutil
from pathlib import Path

import pytest

from ali3.cones import cone_places
from hosts.driving.course import course_of
from hosts.run.command import main as run
from hosts.view.command import main as view
from mbs.vehicle import load
from tests.hosts.test_view import shown


@pytest.mark.slow
def test_a_run_on_the_proving_ground_is_viewed_on_it(proving_ground, prototype_fmu, tmp_path, monkeypatch, capsys):
    """From another folder, with the cones of its driver; when the world has gone that is said."""
    for file in (proving_ground.road, proving_ground.json):
        shutil.copy(file, tmp_path)
    (tmp_path / "out").mkdir()
    monkeypatch.chdir(tmp_path)
    Path("lanes.toml").write_text('stop_time = 0.1\n[driver]\ncourse = "iso_3888_1"\nspeed = 10.0\n')
    assert run([str(prototype_fmu), "-m", "lanes.toml", "--road", "proving_ground.road", "--out", "out"]) == 0
    (table,) = Path("out").glob("*.csv")
    monkeypatch.chdir(tmp_path / "out")
    capsys.readouterr()

    def seen() -> tuple[dict, str]:
        assert view([table.name, "--no-open"]) == 0
        (result,) = shown(Path(table.stem + ".html"))
        return result["scene"], capsys.readouterr().out

    scene, output = seen()
    roads = [{k: v for k, v in road.items() if k not in ("friction_factor", "variables")} for road in scene["roads"]]
    assert roads == proving_ground.record["roads"]
    own = len(proving_ground.record["scenery"])
    assert scene["scenery"][:own] == proving_ground.record["scenery"]
    cones = cone_places(course_of("iso_3888_1", load("prototype").vehicle.width).gates)
    assert [tuple(cone["at"][:2]) for cone in scene["scenery"][own:]] == cones
    assert "not drawn" not in output
    (tmp_path / "proving_ground.json").unlink()
    (tmp_path / "proving_ground.road").unlink()
    scene, output = seen()
    assert scene["roads"] == []
    assert "proving_ground.road is not drawn: its file is not there; that of a world is made again by: " in output
