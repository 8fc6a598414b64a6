"""The page of a run and the simulator draw the same world: equal pixels at the same instant."""

from collections.abc import Callable, Iterator
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
    wait_until(program.page, "epoch => player.cockpit._after?.epoch === epoch", arg=program.epoch)
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


@pytest.mark.slow
def test_the_ground_is_darker_under_the_car_than_beside_it(viewed: Any, driven: Program) -> None:
    """From above, through a car that is not drawn and throws no shadow of the sun; 3 m before it, asphalt too."""

    quality = "low"

    def share(page: Any, picture: Callable[[], np.ndarray]) -> float:
        page.evaluate("quality => { player.view.set({ quality }); player.view.parts.group.visible = false; }", quality)
        solid = "player.view.world.children.find((part) => part.isBatchedMesh)"
        page.evaluate(f"const solid = {solid}; if (solid) solid.material.visible = false;")
        seen = picture().mean(axis=2)
        page.evaluate(f"player.view.parts.group.visible = true; const s = {solid}; if (s) s.material.visible = true;")
        places = "({ view }) => [0, 5].map((a) => view.project([view.origin[0] + a, view.origin[1] - 0.4, 0]))"
        under, beside = (np.round(place).astype(int) for place in page.evaluate(f"({places})(player)"))
        patch = [float(seen[y - 3 : y + 4, x - 3 : x + 4].mean()) for x, y in (under, beside)]
        return patch[0] / patch[1]

    shares = [
        share(viewed, lambda: picture_of_view(viewed, "top", quality)),
        share(driven.page, lambda: picture_of_drive(driven, "top", quality)),
    ]
    assert max(shares) < 0.85
    assert min(shares) > 0.3
    assert shares[0] == pytest.approx(shares[1], abs=0.01)
