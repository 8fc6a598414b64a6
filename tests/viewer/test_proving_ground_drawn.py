"""The proving ground from every place where a car may start: what it costs to draw, and that all of it is known."""

import json
from typing import Any

import numpy as np
import pytest

from mbs import compile
from mbs.vehicle import load
from mbs.worlds import command as world_command
from tests.viewer.test_drawing import at, ball, scene

MOST_CALLS = 200
MOST_TRIANGLES = 1_500_000
_ALL_MARKS = """() => {
  const columns = new Proxy([], { get: (list, key) => (key === "includes" ? () => true : list[key]) });
  window.marks = new ALi3Viewer.TyreMarks(view, { columns });
  const side = [0, 0.1, 0];
  const wheel = { touching: true, surface: "asphalt", use: 2, load: 4000, side, width: 0.2 };
  for (let k = 0; k <= marks.most + 1; k++) {
    const contacts = marks.wheels.list.map((_, w) => ({ ...wheel, at: [0.2 * k, w, 0] }));
    marks.tracks.update(contacts, k, 1);
  }
  marks.update(() => 0, marks.most + 2, 1);
}"""


@pytest.fixture(scope="module")
def proving_ground(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    folder = tmp_path_factory.mktemp("world")
    assert world_command.main(["--world", "proving_ground", "--out", str(folder)]) == 0
    record: dict[str, Any] = json.loads((folder / "proving_ground.json").read_text(encoding="utf-8"))
    return record


@pytest.mark.slow
def test_it_is_drawn_with_few_calls_and_triangles_from_everywhere(drawn, proving_ground):
    roads, scenery = proving_ground["roads"], proving_ground["scenery"]
    drawn.show(scene(focus="body", shapes=[ball(radius=0.02)], roads=roads, scenery=scenery, extent=4.0), at(0, 0, 1))
    assert drawn.ask("view.messages") == []
    drawn.ask("view.camera('chase'), view.parts.group.visible = false")
    calls, triangles = [], []
    for place in proving_ground["places"]:
        half = 0.5 * place["yaw"]
        pose = at(place["x"], place["y"], 1.0, (np.cos(half), 0, 0, np.sin(half)))
        drawn.update(pose)
        cost = drawn.ask("[view.renderer.info.render.calls, view.renderer.info.render.triangles]")
        calls.append(cost[0])
        triangles.append(cost[1])
    assert 10 < max(calls) < MOST_CALLS
    assert 10_000 < max(triangles) < MOST_TRIANGLES


@pytest.mark.slow
def test_its_draft_has_below_fifty_thousand_triangles_with_all_of_it_before_the_eye(drawn, proving_ground):
    """With the car that has the most, whose tyres have left all the marks that are kept, and nothing left out."""
    car = compile(load("prototype").model(fidelity="dynamic")).scene
    world = {"roads": proving_ground["roads"], "scenery": proving_ground["scenery"]}
    drawn.show(car | world, camera="chase", quality="draft")
    drawn.ask(_ALL_MARKS)
    costs = []
    for place in proving_ground["places"]:
        drawn.ask("([x, y]) => { view.origin = [x, y, 1]; view.render(); }", [place["x"], place["y"]])
        drawn.ask("view.world.traverse((part) => (part.frustumCulled = false)), view.render()")
        costs.append(drawn.ask("[view.renderer.info.render.calls, view.renderer.info.render.triangles]"))
    calls, triangles = np.max(costs, axis=0)
    assert calls < 60
    assert 25_000 < triangles < 50_000
