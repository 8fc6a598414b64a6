"""The page of a run and the simulator draw the same world: equal pixels at the same instant."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from ali3.scene.recording import Recording
from tests.in_browser import picture_of_simulator, wait_until
from tests.viewer.hand_world import scenery, terrain
from tests.viewer.simulator_program import Program
from viewer.page_file import write_page

INSTANT = 4.0
"""s: the car turns into the second lane."""
SIZE = {"width": 640, "height": 360}
ALIKE = 2  # of 256 levels of a colour
MOST = 1  # of the 230 400 pixels may differ by more
_BOTH = "({ look }) => { const { view } = window.player; view.options.lift = 0; view.set(look); view.resize(); }"


@pytest.fixture(scope="module")
def run(lane_change: Recording) -> Recording:
    scene = dict(lane_change.scene or {}) | {"roads": [terrain()], "scenery": scenery()}
    return Recording(scene, lane_change.t, lane_change.columns, lane_change.units, lane_change.name)


@pytest.fixture(scope="module")
def viewed(chromium: Any, run: Recording, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    file = tmp_path_factory.mktemp("same") / "run.html"
    write_page(file, run, options={"controls": False}, most=len(run.t))
    page = chromium.new_page(viewport=SIZE)
    page.goto(file.as_uri())
    page.evaluate("async () => { await player.ready; player.set({ path: false }); }")
    yield page
    page.close()


@pytest.fixture(scope="module")
def driven(chromium: Any, run: Recording) -> Iterator[Program]:
    context = chromium.new_context(viewport=SIZE)
    program = Program(context.new_page(), run, scenery=run.scene["scenery"] if run.scene else [])
    program.open()
    program.page.evaluate("document.querySelector('.a3-foot').style.display = 'none'")  # as large as that of the run
    yield program
    context.close()
    assert program.errors == []


def picture_of_view(page: Any, camera: str, quality: str, time: float = INSTANT) -> np.ndarray:
    page.evaluate(_BOTH, {"look": {"quality": quality}})
    page.evaluate("async ([camera, time]) => { player.camera(camera); await player.seek(time); }", [camera, time])
    return picture_of_simulator(page)


def picture_of_drive(program: Program, camera: str, quality: str) -> np.ndarray:
    """Without marks of what was driven before."""
    program.page.evaluate(_BOTH, {"look": {"quality": quality, "arrows": False}})
    program.page.evaluate("name => { player.camera(name); player.view.cameras.trailing.snap(); }", camera)
    program.epoch += 1
    program.send(INSTANT, flags=0)
    wait_until(program.page, "epoch => player.cockpit._drawn?.[1].epoch === epoch", arg=program.epoch)
    return picture_of_simulator(program.page)


def differing(one: np.ndarray, other: np.ndarray) -> int:
    return int((np.abs(one - other).max(axis=2) > ALIKE).sum())


@pytest.mark.slow
@pytest.mark.parametrize(("camera", "quality"), [("chase", "low"), ("side", "draft")])
def test_the_same_instant_is_the_same_picture(viewed: Any, driven: Program, camera: str, quality: str) -> None:
    seen, met = picture_of_view(viewed, camera, quality), picture_of_drive(driven, camera, quality)
    assert np.ptp(seen, axis=(0, 1)).min() > 100, "there is something to be seen"
    assert differing(seen, met) <= MOST


@pytest.mark.slow
def test_another_instant_is_another_picture(viewed: Any, driven: Program) -> None:
    met = picture_of_drive(driven, "chase", "low")
    assert differing(picture_of_view(viewed, "chase", "low", INSTANT + 0.02), met) > 1000
