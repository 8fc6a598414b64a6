"""Pictures of pages at one instant, compared pixel by pixel with those by the script of another checkout."""

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
LYING = (780, 390)
ALIKE = 2
"""Steps of 256 of a colour that two pictures may differ by."""
LIVE = "live"
SIMULATOR = "simulator"
_DATA = re.compile(r'<script type="application/json" id="data">(.*?)</script>', re.DOTALL)
_MEASURED = "[data-a3=pace], [data-a3=flow], [data-a3=missed], [data-a3='step time']"
"""Figures of this machine, which are another ones each time."""
_DRIVEN = "async () => { await player.ready; await player.set('throttle', 0.6); await player.advance(600); }"
_DRAW = """(quality) => {
  (player.player ?? player.cockpit ?? player).setLook({ quality });
}"""
_STANDS = "window.player?.frames?.newest && !player.frames.newest.running && player.frames.newest.time === 0"


@dataclass(frozen=True)
class Shown:
    """A page and the instant of its picture."""

    runs: tuple[str, ...]
    """Films whose runs it shows; or `LIVE`, the FMU of the first command in the tab; or `SIMULATOR`."""
    time: float = 0.0
    """s"""
    size: tuple[int, int] = DESKTOP
    """Pixels."""
    options: Mapping[str, Any] = field(default_factory=dict)
    """Of the player; `theme` and `camera` of the other shells too."""
    keys: tuple[str, ...] = ()
    """That are pressed before."""
    quality: str = "medium"
    """One that does not follow the speed of this machine."""


CAR = "double_lane_change"
OTHER = "hatchback_lane_change"
PAGES = {
    **{
        name: Shown(
            (name,), film.begin + 0.6 * (film.end - film.begin), options={**film.options, "camera": film.camera}
        )
        for name, film in ANIMATIONS.items()
    },
    "ghosts": Shown((CAR, OTHER), 3.0, options={"camera": "chase"}),
    "arrows": Shown((CAR,), 3.4, options={"arrows": True, "plots": ["speed", "chassis.ay"]}),
    "arrows_plane": Shown(("slider_crank",), 2.0, options={"arrows": True}),
    "draft": Shown(("rough",), 2.4, quality="draft"),
    "low": Shown(("proving_ground",), 4.0, quality="low"),
    "stress_phone": Shown(("kerb_test",), 8.2, PHONE, {"stress": True, "deformation": 30.0}),
    "world_phone": Shown(("proving_ground",), 3.0, LYING),
    "settings_dark": Shown((CAR,), 3.0, options={"theme": "dark"}, keys=("o",)),
    "signals_dark": Shown(("puma",), 3.0, PHONE, {"theme": "dark", "plots": []}, ("g",)),
    "keys": Shown((CAR,), 3.0, keys=("?",)),
    "live": Shown((LIVE,), quality="low"),
    "live_stress": Shown((LIVE,), quality="low", options={"camera": "orbit"}, keys=("b",)),
    "live_phone": Shown((LIVE,), quality="low", size=PHONE),
    "simulator": Shown((SIMULATOR,), quality="low"),
    "simulator_stress": Shown((SIMULATOR,), quality="low", options={"camera": "orbit"}, keys=("b", "f")),
    "simulator_panels": Shown((SIMULATOR,), quality="low", keys=("g",)),
    "simulator_map": Shown((SIMULATOR,), quality="low", options={"camera": "map"}),
    "simulator_phone": Shown((SIMULATOR,), quality="low", size=LYING),
}
"""Every scene of the gallery, cars in worlds, stress, ghosts, arrows, the three shells, desktop and phone."""


def compare(options: Namespace) -> list[dict[str, Any]]:
    """Draw pages with the script of this checkout and, if there is one, of another; a row for each page."""
    folder = Path(options.out)
    make_folder(folder)
    scripts = {"": script()}
    if options.other:
        page = options.other / "viewer" / "page"
        scripts["_other"] = bundle(page, options.other / "viewer" / "bundle").read_text(encoding="utf-8")
    rows = []
    with _chromium() as chromium:
        for name in watched(options.only):
            shown = PAGES[name]
            files = {end: folder / f"{name}{end}.png" for end in scripts}
            for end, page_script in scripts.items():
                with _served(name, folder) as (address, text):
                    files[end].write_bytes(_drawn(chromium, shown, address, text, page_script))
            row = {"page": name, "size": " x ".join(map(str, shown.size)), "shows": ", ".join(shown.runs)}
            if options.other:
                row["pixels that differ"] = _differing(*files.values())
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
def _served(name: str, folder: Path) -> Iterator[tuple[str, str]]:
    """The address of a page, and its text where it is not a page of the simulator."""
    shown = PAGES[name]
    if shown.runs == (SIMULATOR,):
        with simulator(_car(), ["--place", "slalom"]) as address:
            yield address, ""
        return
    data = folder / f"{name}.json"  # kept: runs take longer than pictures
    if not data.is_file():
        data.write_text(json.dumps(_data(shown)), encoding="utf-8")
    function = "ALi3Viewer.drive" if shown.runs == (LIVE,) else "ALi3Viewer.playPage"
    file = folder / f"{name}.html"
    yield file.resolve().as_uri(), html_document(name, json.loads(data.read_text(encoding="utf-8")), function)


def _data(shown: Shown) -> dict[str, Any]:
    if shown.runs == (LIVE,):
        with TemporaryDirectory() as directory:
            with redirect_stdout(io.StringIO()):
                view(["--live", "--paused", "--no-open", "--out", directory, str(_car())])
            (file,) = Path(directory).glob("*.html")
            result = _DATA.search(file.read_text(encoding="utf-8"))
            assert result is not None
            return dict(json.loads(result[1]))
    runs = [_recorded(name).thinned() for name in shown.runs]
    return page_data(runs, {key: value for key, value in shown.options.items() if value is not None})


@cache
def _recorded(name: str) -> Any:
    return ANIMATIONS[name].record()


@cache
def _car() -> Path:
    return Path(fmu_of_scene("prototype_car", lambda words: None))


def _drawn(chromium: Any, shown: Shown, address: str, text: str, page_script: str) -> bytes:
    """A picture of a page with a script in place of its own."""
    width, height = shown.size
    scheme = shown.options.get("theme", "light")
    page = chromium.new_page(
        viewport={"width": width, "height": height},
        color_scheme=scheme,
        bypass_csp=True,
        permissions=["local-network-access"],  # a page that comes through playwright is of no network
    )
    page.set_default_timeout(120_000)
    if text:
        Path(address.removeprefix("file://")).write_text(text.replace(script(), page_script), encoding="utf-8")
    else:
        page.route(re.compile(re.escape(address)), lambda route: _with_script(route, page_script))
    page.goto(address)
    if shown.runs == (SIMULATOR,):
        _until(page, "Boolean(window.player?.frames?.newest)")
        if page.evaluate("player.frames.newest.running"):
            page.keyboard.press("p")
        _until(page, "!player.frames.newest.running")
        page.keyboard.press("Home")
        _until(page, _STANDS)
    elif shown.runs == (LIVE,):
        page.evaluate(_DRIVEN)
    else:
        page.evaluate("async (time) => { await player.ready; await player.seek(time); }", shown.time)
    if shown.runs in ((SIMULATOR,), (LIVE,)) and "camera" in shown.options:
        page.evaluate("name => player.camera(name)", shown.options["camera"])
    page.evaluate(_DRAW, shown.quality)
    for key in shown.keys:
        page.keyboard.press(key)
    _until(page, "!document.querySelector('[data-a3=events] > *')")  # they fade
    page.wait_for_timeout(1500)
    picture = bytes(page.screenshot(animations="disabled", mask=[page.locator(_MEASURED)]))
    page.close()
    return picture


def _until(page: Any, holds: str) -> None:
    """Wait until an expression is true; not by pictures, of which there are few here."""
    for _ in range(300):
        if page.evaluate(holds):
            return
        page.wait_for_timeout(200)
    raise RuntimeError(f"Not within a minute: {holds}")


def _with_script(route: Any, page_script: str) -> None:
    answer = route.fetch()
    route.fulfill(response=answer, body=answer.text().replace(script(), page_script))


def _differing(*files: Path) -> int:
    from PIL import Image

    one, other = (np.asarray(Image.open(file).convert("RGB")).astype(int) for file in files)
    return int((np.abs(one - other).max(axis=2) > ALIKE).sum())
