"""A drive that is seen: the running simulator in a Chromium without a window, by keys, in every world and camera.

Frame rates and lateness are printed (``-s``), not asserted: they are those of the machine. The folder that the
environment variable ``ALI3_SESSION_PICTURES`` names keeps the pictures.
"""

import json
import os
import re
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.in_browser import headless_chromium, picture_of_simulator, wait_drawn, wait_until

WORLDS = ("plane", "kerb", "washboard", "rough", "split")
CAMERAS = ("driver", "chase", "wheel FL", "wheel RR", "orbit", "side", "top", "map")
SECONDS = 60.0
_STARTS = 600.0  # s; a world is made on its first use
_NUMBERS = """() => {
  const { steps } = player.cockpit;
  const { time, missed, lateness, worst } = player.frames.newest;
  return { ...player.flow, time, missed, lateness, worst, factor: steps.factor, speed: player.get('speed') };
}"""


@contextmanager
def running(fmu: Path, world: str, *more: str) -> Iterator[str]:
    """The command with a car; gives its address."""
    command = [
        sys.executable,
        "-m",
        "ali3",
        "simulator",
        str(fmu),
        "--world",
        world,
        "--no-open",
        "--no-devices",
        *more,
    ]
    host = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    assert host.stdout is not None
    lines = []
    try:
        until = time.monotonic() + _STARTS
        for line in host.stdout:
            lines.append(line)
            match = re.search(r"http://\S+", line)
            if match or time.monotonic() > until:
                break
        assert match, "".join(lines)
        yield match[0]
    finally:
        host.send_signal(2)
        try:
            print(host.communicate(timeout=30)[0])
        except subprocess.TimeoutExpired:
            host.kill()
            host.communicate()


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with headless_chromium() as chromium:
        yield chromium


class Driver:
    """Somebody before the page."""

    def __init__(self, browser: Any, address: str, name: str) -> None:
        self.page = browser.new_page(viewport={"width": 640, "height": 360})
        self.page.set_default_timeout(120_000)
        self.wrong: list[str] = []
        self.name = name
        self.page.on("pageerror", lambda error: self.wrong.append(str(error)))
        self.page.on("console", lambda m: m.type == "error" and self.wrong.append(m.text))
        self.page.goto(address)
        wait_until(self.page, "window.player?.frames.newest?.running", timeout=120.0)

    def ask(self, expression: str, *values: Any) -> Any:
        return self.page.evaluate(expression, *values)

    def look(self, camera: str) -> None:
        """Choose a camera, and wait for a picture of it."""
        assert self.ask("name => player.camera(name)", camera) == ""
        self.ask("() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")

    def picture(self, keep: str = "") -> np.ndarray:
        """Pixels without instruments; kept with them under a name."""
        folder = os.environ.get("ALI3_SESSION_PICTURES")
        if folder and keep:
            Path(folder).mkdir(parents=True, exist_ok=True)
            self.page.screenshot(path=str(Path(folder, f"{self.name}_{keep.replace(' ', '_')}.png")))
        return picture_of_simulator(self.page)

    def say(self, what: str) -> None:
        """Print how it goes."""
        n = self.ask(_NUMBERS)
        factor = "-" if n["factor"] is None else f"{n['factor']:.3f}"
        print(
            f"{self.name:15} {what:10} {n['time']:6.2f} s, {3.6 * n['speed']:4.0f} km/h: {n['drawn']:.1f} pictures/s "
            f"(longest {1e3 * n['longest']:.0f} ms), {n['received']} frames/s, {1e3 * n['delay']:.0f} ms behind; "
            f"simulated over wall {factor}, step at most {1e3 * n['worst']:.2f} ms, late {1e3 * n['lateness']:.2f} ms, "
            f"missed {n['missed']:.0f}"
        )

    def begin_at(self, place: str) -> None:
        """Begin again at a place of the world."""
        epoch = self.ask("player.frames.newest.epoch")
        self.ask("name => player.cockpit.acts.place(name)", place)
        wait_until(self.page, "epoch => player.frames.newest.epoch > epoch", arg=epoch)

    def still(self) -> None:
        """Time stands, and the picture with it."""
        self.page.keyboard.press("p")
        wait_until(self.page, "!player.frames.newest.running")
        self.ask("() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")

    def point(self, *names: str) -> list[float]:
        return [float(self.ask("name => player.get(name)", name)) for name in names]

    def close(self) -> None:
        self.page.close()
        assert self.wrong == []


_TUBES = """() => {
  const { view } = player;
  const tubes = view.scene.shapes.filter(shape => shape.kind === 'tube' && shape.name === 'frame tube');
  return tubes.map(({ points: [[a, p], [b, q]] }) => {
    const [from, to] = [view.parts.frames.point(a, p), view.parts.frames.point(b, q)];
    return view.project(from.map((x, k) => (x + to[k]) / 2));
  });
}"""


def frame_is_seen(driver: Driver, camera: str, pixels: np.ndarray) -> None:
    """The middles of the red tubes of the frame are red, where the car's pose has them; some hide behind others."""
    r, g, b = (pixels[..., k] for k in range(3))
    red = (r > g + 35) & (r > b + 25)
    places = [(int(x), int(y)) for x, y in driver.ask(_TUBES)]
    inside = [(x, y) for x, y in places if 4 < x < 636 and 4 < y < 356]
    assert len(inside) > 10, camera
    seen = sum(bool(red[y - 1 : y + 2, x - 1 : x + 2].any()) for x, y in inside)
    assert seen >= 0.6 * len(inside), f"{camera}: {seen} of {len(inside)} tubes are where they should be"
    assert red.mean() < 0.2  # and not everywhere


@pytest.mark.proof
@pytest.mark.parametrize("world", WORLDS)
def test_every_world_is_driven_and_seen(fmu, browser, world):
    with running(fmu("prototype_car"), world) as address:
        driver = Driver(browser, address, world)
        driver.page.keyboard.down("ArrowUp")
        wait_until(driver.page, "player.get('speed') > 5", timeout=60.0)
        for camera in CAMERAS:
            driver.look(camera)
            driver.picture(camera)
            driver.say(camera)
        driver.page.keyboard.up("ArrowUp")
        driver.still()
        seen = {}
        for camera in ("chase", "side", "top"):
            driver.look(camera)
            seen[camera] = driver.picture(f"{camera} still")
            frame_is_seen(driver, camera, seen[camera])
        assert np.abs(seen["chase"] - seen["top"]).mean() > 5.0
        driver.close()


@pytest.mark.proof
def test_a_minute_on_the_proving_ground(fmu, browser):
    """Through its places with keys: throttle, steering, brake, rewind, set upright, slow motion, all cameras."""
    with running(fmu("prototype_car"), "proving_ground") as address:
        driver = Driver(browser, address, "proving_ground")
        places = driver.ask("player.cockpit.hello.world.places.map(place => place.name)")
        assert len(places) > 8
        keyboard = driver.page.keyboard
        begin = time.monotonic()
        tour = 0
        while time.monotonic() - begin < SECONDS or tour < len(places):
            place, camera = places[tour % len(places)], CAMERAS[tour % len(CAMERAS)]
            driver.begin_at(place)
            driver.look(camera)
            keyboard.down("ArrowUp")
            wait_until(driver.page, "player.get('speed') > 4", timeout=60.0)
            key = "ArrowLeft" if tour % 2 else "ArrowRight"
            keyboard.down(key)
            driver.page.wait_for_timeout(500)
            keyboard.up(key)
            driver.page.wait_for_timeout(1500)
            driver.picture(f"{tour:02} {place} {camera}")
            keyboard.up("ArrowUp")
            driver.say(f"{place[:10]}")
            tour += 1
        # one goes two seconds back, and drives on
        before = driver.ask("({epoch: player.frames.newest.epoch, time: player.frames.newest.time})")
        keyboard.press("Backspace")
        wait_until(driver.page, "epoch => player.frames.newest.epoch > epoch", arg=before["epoch"])
        assert driver.ask("player.frames.newest.time") < before["time"] + 60.0
        driver.begin_at("slalom")
        wait_drawn(driver.page)
        driver.still()
        driver.look("chase")
        cones_are_seen(driver)
        report = driver.ask("""() => new Promise(done => {
          const { report } = player.cockpit;
          const show = report.show.bind(report);
          report.show = given => { show(given); done(given); };
          player.link.send({ type: 'report' });
        })""")
        print(json.dumps({k: v for k, v in report.items() if k not in ("cost", "lateness")}))
        print("cost", {k: v for k, v in report["cost"].items() if k != "bins"})
        assert report["steps"] > 1000
        assert driver.page.locator('[data-a3="histogram"] rect').count() > 0
        driver.close()


def cones_are_seen(driver: Driver) -> None:
    """The cones before the car stand where the world says: orange there."""
    pixels = driver.picture("cones")
    r, g, b = (pixels[..., k] for k in range(3))
    orange = (r > 140) & (r > g + 50) & (g > b)
    x, y = driver.point("chassis.x", "chassis.y")
    cones = [t["at"] for t in driver.ask("player.cockpit.plan.scenery.filter(t => t.kind === 'cone')")]
    near = [at for at in cones if 8.0 < at[0] - x < 45.0 and abs(at[1] - y) < 4.0]
    assert near, "no cones before the car"
    result = 0
    for at in near:
        place = driver.ask("point => player.view.project(point)", [at[0], at[1], at[2] + 0.2])
        assert place is not None
        px, py = (int(p) for p in place)
        result += bool(orange[py - 4 : py + 5, px - 4 : px + 5].any())
    assert result >= 0.6 * len(near), f"{result} of {len(near)} cones are seen"  # the car hides some
