"""A drive that is seen: the running simulator in a Chromium without a window, by keys."""

from typing import Any

import numpy as np
import pytest

from tests.hosts.simulator.test_with_pages import program
from tests.in_browser import headless_chromium, picture_of_simulator, wait_until

_TUBES = """() => {
  const { view } = player;
  const tubes = view.scene.shapes.filter(shape => shape.kind === 'tube' && shape.name === 'frame tube');
  return tubes.map(({ points: [[a, p], [b, q]] }) => {
    const [from, to] = [view.parts.frames.point(a, p), view.parts.frames.point(b, q)];
    return view.project(from.map((x, k) => (x + to[k]) / 2));
  });
}"""


def frame_is_seen(page: Any, camera: str, pixels: np.ndarray) -> None:
    """The middles of the red tubes of the frame are red, where the car's pose has them; some hide behind others."""
    r, g, b = (pixels[..., k] for k in range(3))
    red = (r > g + 35) & (r > b + 25)
    places = [(int(x), int(y)) for x, y in page.evaluate(_TUBES)]
    inside = [(x, y) for x, y in places if 4 < x < 636 and 4 < y < 356]
    assert len(inside) > 10, camera
    seen = sum(bool(red[y - 1 : y + 2, x - 1 : x + 2].any()) for x, y in inside)
    assert seen >= 0.6 * len(inside), f"{camera}: {seen} of {len(inside)} tubes are where they should be"
    assert red.mean() < 0.2  # and not everywhere


@pytest.mark.proof
@pytest.mark.parametrize("world", ["plane", "rough", "proving_ground"])
def test_a_world_is_driven_and_seen(prototype_fmu, world):
    with program(prototype_fmu, "--port", 0, "--world", world) as running, headless_chromium() as browser:
        page = browser.new_page(viewport={"width": 640, "height": 360})
        wrong = []
        page.on("pageerror", lambda error: wrong.append(str(error)))
        page.on("console", lambda m: m.type == "error" and wrong.append(m.text))
        page.goto(running.address, timeout=120_000)
        wait_until(page, "window.player?.frames.newest?.running", timeout=120.0)
        page.keyboard.down("ArrowUp")
        wait_until(page, "player.get('speed') > 5", timeout=120.0)
        page.keyboard.up("ArrowUp")
        page.keyboard.press("p")
        wait_until(page, "!player.frames.newest.running")
        for camera in ("chase", "side", "top"):
            assert page.evaluate("name => player.camera(name)", camera) == ""
            page.evaluate("() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
            frame_is_seen(page, camera, picture_of_simulator(page))
        assert wrong == []
        assert running.end() == 0
