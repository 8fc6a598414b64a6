"""The proving ground from every place where a car may start: what it costs to draw, and that all of it is known."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

from mbs.worlds import command as world_command
from tests.viewer.test_drawing import at, ball, scene

MOST_CALLS, MOST_TRIANGLES = 200, 1_500_000


@pytest.fixture(scope="module")
def proving_ground(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    folder = tmp_path_factory.mktemp("world")
    assert world_command.main(["--world", "proving_ground", "--out", str(folder)]) == 0
    made: dict[str, Any] = json.loads((folder / "proving_ground.json").read_text(encoding="utf-8"))
    return made


@pytest.mark.slow
def test_it_is_drawn_with_few_calls_and_triangles_from_everywhere(drawn, proving_ground):
    roads, scenery = proving_ground["roads"], proving_ground["scenery"]
    drawn.show(scene(focus="body", shapes=[ball(radius=0.02)], roads=roads, scenery=scenery, extent=4.0), at(0, 0, 1))
    assert drawn.ask("view.messages") == []
    drawn.ask("view.parts.group.visible = false")
    calls, triangles = [], []
    for place in proving_ground["places"]:
        half = 0.5 * place["yaw"]
        pose = at(place["x"], place["y"], 1.0, (np.cos(half), 0, 0, np.sin(half)))
        for camera in ("chase", "top"):
            drawn.ask("name => view.camera(name)", camera)
            drawn.update(pose)
            cost = drawn.ask("[view.renderer.info.render.calls, view.renderer.info.render.triangles]")
            calls.append(cost[0])
            triangles.append(cost[1])
        picture = drawn.picture()
        assert picture.std() > 3, place["name"]
    print(f"at most {max(calls)} calls and {max(triangles)} triangles")
    assert 10 < max(calls) < MOST_CALLS
    assert 10_000 < max(triangles) < MOST_TRIANGLES
