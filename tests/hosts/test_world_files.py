"""Worlds that hosts build by the command."""

import json
from pathlib import Path

import pytest

from hosts.common.errors import HostError
from hosts.common.world_files import make_world

WORLD = 'kind = "world"\nname = "{name}"\nbounds = [-20.0, -20.0, 20.0, 20.0]\nspacing = [1.0, 1.0]\n'
STEEP = '[[courses]]\nname = "hill"\npoints = "hill.csv"\nsmoothing = 1.0\nwidth = 3.0\nblend = 5.0\n'


@pytest.mark.slow
def test_a_description_has_its_own_name_and_warnings_of_the_command_are_reported(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
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
