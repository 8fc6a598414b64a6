"""Pictures of pages at one instant, compared pixel by pixel with pictures by the script of another checkout."""

import io
import json
import re
from argparse import Namespace
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, redirect_stdout
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from ali3.files import make_folder
from benchmarks.pictures.animations import ANIMATIONS
from benchmarks.pictures.simulator import simulator
from benchmarks.shared.command import watched
from hosts.fmu.built_fmu import fmu_of_scene
from hosts.view.command import main as view
from viewer import browser
from viewer.bundle import bundle
from viewer.html_document import html_document, script
from viewer.page_data import page_data

DESKTOP = (1280, 720)
PHONE = (390, 780)
PHONE_LANDSCAPE = (780, 390)
MAX_COLOUR_DIFFERENCE = 2
"""Largest difference of equal pixels in a colour, of 255."""
LIVE = "live"
SIMULATOR = "simulator"
_DATA = re.compile(r'<script type="application/json" id="data">(.*?)</script>', re.DOTALL)
_MEASURED = "[data-a3=pace], [data-a3=flow], [data-a3=missed], [data-a3='step time']"
"""Elements with times of this machine, which differ in each picture."""
_DRIVEN = "async () => { await player.ready; await player.set('throttle', 0.6); await player.advance(600); }"
_DRAW = """(quality) => {
  (player.player ?? player.cockpit ?? player).setLook({ quality });
}"""
_STANDS = "window.player?.frames?.newest && !player.frames.newest.running && player.frames.newest.time === 0"


@dataclass(frozen=True)
class Page:
    """A page and the instant of its picture."""

    runs: tuple[str, ...]
    """Films whose runs the page shows; or `LIVE`: the FMU of the first command runs in the page; or `SIMULATOR`."""
    time: float = 0.0
    """Instant, s."""
    size: tuple[int, int] = DESKTOP
    """Pixels."""
    options: Mapping[str, Any] = field(default_factory=dict)
    """Options of the player; `theme` and `camera` also of the other pages."""
    keys: tuple[str, ...] = ()
    """Keys that are pressed before the picture."""
    quality: str = "medium"
    """Drawing quality, independent of the speed of this machine."""


CAR = "double_lane_change"
SECOND_CAR = "hatchback_lane_change"
PAGES = {
    **{
        name: Page((name,), film.begin + 0.6 * (film.end - film.begin), options={**film.options, "camera": film.camera})
        for name, film in ANIMATIONS.items()
    },
    "ghosts": Page((CAR, SECOND_CAR), 3.0, options={"camera": "chase"}),
    "arrows": Page((CAR,), 3.4, options={"arrows": True, "plots": ["speed", "chassis.ay"]}),
    "arrows_plane": Page(("slider_crank",), 2.0, options={"arrows": True}),
    "draft": Page(("rough",), 2.4, quality="draft"),
    "low": Page(("proving_ground",), 4.0, quality="low"),
    "stress_phone": Page(("kerb_test",), 8.2, PHONE, {"stress": True, "deformation": 30.0}),
    "world_phone": Page(("proving_ground",), 3.0, PHONE_LANDSCAPE),
    "settings_dark": Page((CAR,), 3.0, options={"theme": "dark"}, keys=("o",)),
    "signals_dark": Page(("puma",), 3.0, PHONE, {"theme": "dark", "plots": []}, ("g",)),
    "keys": Page((CAR,), 3.0, keys=("?",)),
    "live": Page((LIVE,), quality="low"),
    "live_stress": Page((LIVE,), quality="low", options={"camera": "orbit"}, keys=("b",)),
    "live_phone": Page((LIVE,), quality="low", size=PHONE),
    "simulator": Page((SIMULATOR,), quality="low"),
    "simulator_stress": Page((SIMULATOR,), quality="low", options={"camera": "orbit"}, keys=("b", "f")),
    "simulator_panels": Page((SIMULATOR,), quality="low", keys=("g",)),
    "simulator_map": Page((SIMULATOR,), quality="low", options={"camera": "map"}),
    "simulator_phone": Page((SIMULATOR,), quality="low", size=PHONE_LANDSCAPE),
}
"""Every scene of the gallery, cars in worlds, stress, ghosts, arrows, the three kinds of page, desktop and phone."""


def compare(options: Namespace) -> list[dict[str, Any]]:
    """Draw pages with the script of this checkout and, if given, of another; a row for each page."""
    folder = Path(options.out)
    make_folder(folder)
    scripts = {"": script()}
    if options.other:
        page = options.other / "viewer" / "page"
        scripts["_other"] = bundle(page, options.other / "viewer" / "bundle").read_text(encoding="utf-8")
    rows = []
    with _chromium() as chromium:
        for name in watched(options.only):
            entry = PAGES[name]
            files = {end: folder / f"{name}{end}.png" for end in scripts}
            for end, page_script in scripts.items():
                with _serve(name, folder) as (address, text):
                    files[end].write_bytes(_screenshot(chromium, entry, address, text, page_script))
            row = {"page": name, "size": " x ".join(map(str, entry.size)), "shows": ", ".join(entry.runs)}
            if options.other:
                row["pixels that differ"] = _count_differences(*files.values())
            rows.append(row)
    return rows


@contextmanager
def _chromium() -> Iterator[Any]:
    from playwright.sync_api import sync_playwright

    with sync_playwright() as play:
        chromium = play.chromium.launch(executable_path=browser.find_chromium(), args=browser.launch_arguments())
        yield chromium
        chromium.close()


@contextmanager
def _serve(name: str, folder: Path) -> Iterator[tuple[str, str]]:
    """Context of a page: its address, and its text if it is not a page of the simulator."""
    entry = PAGES[name]
    if entry.runs == (SIMULATOR,):
        with simulator(_car(), ["--place", "slalom"]) as address:
            yield address, ""
        return
    data = folder / f"{name}.json"  # reused: runs take longer than pictures
    if not data.is_file():
        data.write_text(json.dumps(_data(entry)), encoding="utf-8")
    page_class = "Drive" if entry.runs == (LIVE,) else "Player"
    file = folder / f"{name}.html"
    yield file.resolve().as_uri(), html_document(name, json.loads(data.read_text(encoding="utf-8")), page_class)


def _data(entry: Page) -> dict[str, Any]:
    if entry.runs == (LIVE,):
        with TemporaryDirectory() as directory:
            with redirect_stdout(io.StringIO()):
                view(["--live", "--paused", "--no-open", "--out", directory, str(_car())])
            (file,) = Path(directory).glob("*.html")
            result = _DATA.search(file.read_text(encoding="utf-8"))
            assert result is not None
            return dict(json.loads(result[1]))
    runs = [_recording(name).thinned() for name in entry.runs]
    return page_data(runs, {key: value for key, value in entry.options.items() if value is not None})


@cache
def _recording(name: str) -> Any:
    return ANIMATIONS[name].record()


@cache
def _car() -> Path:
    return Path(fmu_of_scene("prototype_car", lambda words: None))


def _screenshot(chromium: Any, entry: Page, address: str, text: str, page_script: str) -> bytes:
    """Screenshot of a page with a script instead of its own."""
    width, height = entry.size
    scheme = entry.options.get("theme", "light")
    page = chromium.new_page(
        viewport={"width": width, "height": height},
        color_scheme=scheme,
        bypass_csp=True,
        permissions=["local-network-access"],  # a page that playwright serves has no network
    )
    page.set_default_timeout(120_000)
    if text:
        Path(address.removeprefix("file://")).write_text(text.replace(script(), page_script), encoding="utf-8")
    else:
        page.route(re.compile(re.escape(address)), lambda route: _with_script(route, page_script))
    page.goto(address)
    if entry.runs == (SIMULATOR,):
        _wait_until(page, "Boolean(window.player?.frames?.newest)")
        if page.evaluate("player.frames.newest.running"):
            page.keyboard.press("p")
        _wait_until(page, "!player.frames.newest.running")
        page.keyboard.press("Home")
        _wait_until(page, _STANDS)
    elif entry.runs == (LIVE,):
        page.evaluate(_DRIVEN)
    else:
        page.evaluate("async (time) => { await player.ready; await player.seek(time); }", entry.time)
    if entry.runs in ((SIMULATOR,), (LIVE,)) and "camera" in entry.options:
        page.evaluate("name => player.camera(name)", entry.options["camera"])
    page.evaluate(_DRAW, entry.quality)
    for key in entry.keys:
        page.keyboard.press(key)
    _wait_until(page, "!document.querySelector('[data-a3=events] > *')")  # they fade
    page.wait_for_timeout(1500)
    picture = bytes(page.screenshot(animations="disabled", mask=[page.locator(_MEASURED)]))
    page.close()
    return picture


def _wait_until(page: Any, expression: str) -> None:
    """Wait until an expression is true; polled by time, since few frames are drawn."""
    for _ in range(300):
        if page.evaluate(expression):
            return
        page.wait_for_timeout(200)
    raise RuntimeError(f"Not within a minute: {expression}")


def _with_script(route: Any, page_script: str) -> None:
    answer = route.fetch()
    route.fulfill(response=answer, body=answer.text().replace(script(), page_script))


def _count_differences(*files: Path) -> int:
    from PIL import Image

    one, other = (np.asarray(Image.open(file).convert("RGB")).astype(int) for file in files)
    return int((np.abs(one - other).max(axis=2) > MAX_COLOUR_DIFFERENCE).sum())
