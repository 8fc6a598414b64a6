"""The player in a headless browser: what it shows at a time, its controls, and no network requests."""

import io
import re
import zlib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from ali3.scene.recording import Recording
from tests.in_browser import WITHOUT_WEBGL, wait_until
from tests.viewer import moving_car
from tests.viewer.hand_scenes import crank
from viewer.notebook import html_of
from viewer.page_file import write_page

SIZE = (640, 360)
INSTRUMENTS = """[...document.querySelectorAll('.a3-view, .a3-tyres, .a3-inset, .a3-cluster')]
  .filter((part) => part.checkVisibility()).map((part) => part.getBoundingClientRect().toJSON())"""
TIMES = np.linspace(0.0, 3.0, 301)


class Opened:
    """A page with what it did."""

    def __init__(
        self, browser: Any, file: Path, hash_text: str = "", size: tuple[int, int] = SIZE, script: str = ""
    ) -> None:
        self.page = browser.new_page(viewport={"width": size[0], "height": size[1]})
        self.said: list[str] = []
        self.asked: list[str] = []
        self.page.on("console", lambda message: self.said.append(f"{message.type}: {message.text}"))
        self.page.on("pageerror", lambda error: self.said.append(str(error)))
        self.page.on("request", lambda request: self.asked.append(request.url))
        self.page.add_init_script(script)
        self.page.goto(file.resolve().as_uri() + hash_text)
        self.page.evaluate("async () => { await window.player.ready; }")

    def __call__(self, script: str, *values: Any) -> Any:
        return self.page.evaluate(script, *values)

    def seek(self, t: float) -> None:
        self("t => window.player.seek(t)", t)

    def picture(self) -> np.ndarray:
        return np.asarray(Image.open(io.BytesIO(self.page.screenshot())).convert("RGB")).astype(int)

    def place(self, point: list[float]) -> tuple[int, int]:
        x, y = self("p => window.player.view.project(p)", point)
        return round(x), round(y)


@pytest.fixture
def opened(chromium: Any, tmp_path: Path) -> Iterator[Callable[..., Opened]]:
    """Opens recordings in pages that are closed after the test: each that is open takes time of all others."""
    pages: list[Opened] = []

    def open_page(
        *recordings: Recording, hash_text: str = "", size: tuple[int, int] = SIZE, script: str = "", **options: Any
    ) -> Opened:
        file = tmp_path / f"page {len(pages)} äö.html"
        write_page(file, recordings, options=options)
        pages.append(Opened(chromium, file, hash_text, size, script))
        return pages[-1]

    yield open_page
    for page in pages:
        page.page.close()


@pytest.fixture(scope="module")
def pair(chromium: Any, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Opened]:
    """A crank, and a faster one that ends before it as its ghost."""
    other = crank(np.linspace(0.0, 2.5, 1001), 2.5, "faster </script><b>crank")
    file = tmp_path_factory.mktemp("pages") / "pair äö.html"
    write_page(file, (crank(TIMES), other), options={"plots": ["angle", "fx"], "camera": "orbit"})
    opened = Opened(chromium, file)
    yield opened
    opened.page.close()


def slider(t: float, speed: float = 2.0) -> float:
    return float(0.5 * np.cos(speed * t) + np.sqrt(1.0 - (0.5 * np.sin(speed * t)) ** 2))


def is_red(colour: np.ndarray) -> bool:
    red, green, blue = colour
    return bool(red > 1.5 * green + 20 and red > 1.5 * blue + 20)


def test_it_opens_from_disk_without_a_complaint_and_asks_for_nothing(pair):
    assert pair("player.problem") == ""
    assert [line for line in pair.said if not line.startswith("warning: ")] == []
    assert [url for url in pair.asked if not url.startswith(("file:", "blob:", "data:"))] == []
    assert len([url for url in pair.asked if url.startswith("file:")]) == 1


def test_at_a_time_the_slider_is_where_it_belongs(pair):
    pair("player.showGhost(player.ghosts[0], false)")
    for t in (0.0, 0.515):
        pair.seek(t)
        picture = pair.picture()
        for x, there in ((slider(t), True), (slider(t) - 0.3, False), (slider(t) + 0.3, False)):
            column, row = pair.place([x, 0.0, 0.1])
            assert is_red(picture[row, column]) == there, (t, x, picture[row, column])
    pair("player.showGhost(player.ghosts[0], true)")


def test_a_ghost_moves_in_step_and_stands_still_after_its_end(pair):
    pair("player.showGhost(player.ghosts[0], false)")
    for t in (0.9, 2.9):
        pair("player.showGhost(player.ghosts[0], false)")
        pair.seek(t)
        without = pair.picture()
        pair("player.showGhost(player.ghosts[0], true)")
        pair.seek(t)
        with_it = pair.picture()
        column, row = pair.place([slider(min(t, 2.5), 2.5), 0.0, 0.1])
        assert np.abs(with_it[row, column] - without[row, column]).max() > 15
        column, row = pair.place([0.9, -0.45, 0.0])
        assert np.abs(with_it[row, column] - without[row, column]).max() < 5
    notices = pair.page.inner_text(".a3-notices")
    assert "lasts from 0 s to 2.5 s" in notices
    assert "faster </script><b>crank (ghost)" in notices


def test_the_slider_the_keys_and_the_diagram_go_to_a_time(pair):
    pair("""() => { const s = document.querySelector('.a3-slide'); s.value = '1.25';
                    s.dispatchEvent(new Event('input')); }""")
    assert pair("player.time") == pytest.approx(1.25)
    pair.page.keyboard.press("ArrowRight")
    assert pair("player.time") == pytest.approx(1.26)
    pair.page.keyboard.press("Shift+ArrowLeft")
    assert pair("player.time") == pytest.approx(1.16)
    pair.page.keyboard.press("End")
    assert pair("player.time") == pytest.approx(3.0)
    pair.page.keyboard.press("Home")
    assert pair("player.time") == 0.0
    assert pair.page.inner_text(".a3-time") == "0.00 / 3.00 s"
    box = pair.page.locator(".u-over").first.bounding_box()
    pair.page.mouse.click(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    assert pair("player.time") == pytest.approx(1.5, abs=0.02)
    translation = pair("document.querySelector('.a3-now').style.transform")
    assert float(translation.removeprefix("translateX(").removesuffix("px)")) == pytest.approx(box["width"] / 2, abs=2)
    shown = pair("document.querySelector('.a3-legend output').textContent")
    assert float(shown.removesuffix(" rad")) == pytest.approx(2.0 * pair("player.time"), abs=1e-3)
    assert pair("document.querySelector('.a3-legend output').ariaLive") == "off", "it changes in each picture"


def test_a_slider_with_the_focus_follows_the_time_and_says_it(pair):
    pair.seek(1.0)
    slider = pair.page.locator(".a3-slide")
    slider.focus()
    pair.page.keyboard.press(".")
    assert float(slider.input_value()) == pytest.approx(1.01)
    assert slider.get_attribute("aria-valuetext") == "1.01 / 3.00 s"
    pair("document.activeElement.blur()")


def test_it_plays_in_time_and_stops_at_the_key(pair):
    pair("player.seek(0)")
    pair("player.speed(0.2)")
    pair.page.keyboard.press(" ")
    wait_until(pair.page, "player.time > 0.05")
    assert pair("document.querySelector('[data-a3=toggle]').ariaPressed") == "true"
    pair.page.keyboard.press(" ")
    stands = pair("player.time")
    pair.page.wait_for_timeout(200)
    assert pair("player.time") == stands
    pair("player.speed(1)")


def test_the_difference_of_runs(pair):
    pair.page.locator(".a3-legend button").first.click()
    t, difference = pair("player.plots.charts[0].plot.data.map(column => Array.from(column))")
    shown = np.array([np.nan if x is None else x for x in difference])
    np.testing.assert_allclose(shown[:251], 0.5 * np.array(t)[:251], atol=1e-5)
    assert np.isnan(shown[251:]).all()
    pair.page.locator(".a3-legend button").first.click()
    count = pair("player.plots.charts[0].plot.data.length")
    assert count == 3


def test_settings_and_signals_are_chosen_by_keys(opened):
    """Settings show what keys and programs set; the space bar does not play while a signal has the focus."""
    page = opened(crank(TIMES), arrows=False)
    page.page.locator(".a3-bar button", has_text="settings").click()
    box = page.page.locator(".a3-panel input[type=checkbox]").first
    assert not box.is_checked()
    page.page.keyboard.press("f")
    assert box.is_checked()
    assert page("player.look.arrows") is True
    page("player.set({arrowScale: 5})")
    assert "5×" in page.page.inner_text(".a3-panel")
    page.page.locator(".a3-panel input[type=range]").first.fill("1")
    assert page("player.look.arrowScale") == 10
    page.page.keyboard.press("Escape")
    assert not page.page.locator(".a3-panel").is_visible()
    page.page.keyboard.press("F")  # the same letter with caps lock
    assert page("player.look.arrows") is False
    page.page.keyboard.press("G")
    page.page.locator(".a3-find input").focus()
    page.page.keyboard.press("Tab")  # the button that shows the list
    page.page.keyboard.press(" ")
    page.page.locator(".a3-find input").focus()
    assert not page.page.locator(".a3-list").is_visible(), "the Tab key passes it"
    page.page.keyboard.press("Tab")
    page.page.keyboard.press(" ")
    page.page.keyboard.press("Tab")
    page.page.keyboard.press(" ")
    (first,) = page("player.plots.chosen")
    assert page("document.activeElement.checked") is True
    page.page.keyboard.press(" ")
    assert page("player.plots.chosen") == []
    assert page("player.source.running") is False
    page.page.locator(".a3-list label", has_text=first).first.click()
    page.page.keyboard.press(" ")  # after a click the keys are the page's
    assert page("player.source.running") is True
    assert page("player.plots.chosen") == [first]


def test_signals_are_searched_and_chosen(pair):
    pair.page.fill(".a3-find input", "crank qz")
    assert pair.page.locator(".a3-list label").count() == 1
    pair.page.locator(".a3-list input").click()
    assert pair("player.plots.chosen") == ["angle", "fx", "crank.qz"]
    assert pair.page.locator(".a3-chart").count() == 3
    pair.page.locator(".a3-list input").click()
    pair.page.fill(".a3-find input", "nothing like it")
    assert "no signal has these words" in pair.page.inner_text(".a3-list")
    pair.page.fill(".a3-find input", "")
    pair("document.activeElement.blur()")


def test_the_address_names_the_displayed_state(opened):
    page = opened(crank(TIMES), hash_text="#t=1.5&plots=fx&speed=0.5")
    assert page("player.time") == 1.5
    assert page("player.source.speed") == 0.5
    assert page("player.plots.chosen") == ["fx"]
    page.seek(2.25)
    page.page.wait_for_url("**#t=2.25&speed=0.5&plots=fx")


def test_it_fits_small_screens(opened):
    """From its first picture on, and when the window changes."""
    sizes = [(360, 640), (640, 360), (320, 480)]
    page = opened(crank(TIMES), size=sizes[0], plots=["angle"])
    outside = {}
    for size in sizes:
        page.page.set_viewport_size({"width": size[0], "height": size[1]})
        page("player.seek(0)")  # drawn once more
        assert page("[document.documentElement.scrollWidth, document.documentElement.scrollHeight]") == list(size)
        for selector in (".a3-view", ".a3-bar", ".a3-slide", ".a3-chart canvas", ".a3-group button"):
            box = page.page.locator(selector).first.bounding_box()
            across = box["width"] > 20 and box["x"] >= 0 and box["x"] + box["width"] <= size[0] + 1
            if not (across and box["y"] < size[1]):
                outside[size, selector] = box
        if page.page.locator(".a3-view").bounding_box()["height"] <= 100:
            outside[size, "height"] = page.page.locator(".a3-view").bounding_box()
    assert outside == {}


def test_legends_lie_on_no_instrument(opened):
    """Of a crank with numbers as those of a car."""
    numbers = dict.fromkeys(["speed", *(f"wheel_{w}.Fz" for w in ("FL", "FR", "RL", "RR"))], TIMES)
    result = crank(TIMES)
    page = opened(Recording(result.scene, TIMES, {**result.columns, **numbers}), arrows=True, plots=["speed"])
    for width, height in ((1280, 720), (800, 450), (390, 844), (844, 390), (900, 700)):
        page.page.set_viewport_size({"width": width, "height": height})
        page.seek(0.5)
        parts = [".a3-cluster", ".a3-tyres", "[data-legend=arrows]", ".a3-notices", ".a3-bar"]
        boxes = {part: page.page.locator(part).first.bounding_box() for part in parts}
        legend = boxes.pop("[data-legend=arrows]")
        for name, box in boxes.items():
            beside = legend["x"] >= box["x"] + box["width"] or legend["x"] + legend["width"] <= box["x"]
            above = legend["y"] >= box["y"] + box["height"] or legend["y"] + legend["height"] <= box["y"]
            assert beside or above, (width, height, name)


def test_one_time_is_a_picture_that_stands(opened):
    page = opened(crank(np.zeros(1)), plots=["angle"], camera="moon")
    assert page("player.problem") == ""
    assert "There is no camera 'moon'" in page.page.inner_text(".a3-notices")
    assert page.said == []
    page("player.play()")
    assert page("player.source.running") is False
    assert page.page.locator(".a3-slide").is_disabled()


def test_a_result_without_a_scene_has_its_diagrams_or_reports_that_there_are_none(opened):
    page = opened(Recording(None, TIMES, {"x": np.sin(TIMES)}, {"x": "m"}, "foreign"), plots=["x"])
    assert "no poses in this result" in page.page.inner_text(".a3-notices")
    assert page.page.locator(".a3-chart canvas").bounding_box()["height"] > 100
    page.seek(1.0)
    assert page("document.querySelector('.a3-legend output').textContent") == "0.84147 m"
    empty = opened(Recording(None, TIMES, {}, name="empty"))
    assert empty.page.inner_text(".a3-list") == "there are no signals"
    assert page.said == empty.said == []


def test_ticks_of_a_diagram_differ_for_small_numbers_and_small_changes(opened):
    columns = {"strain": 1e-6 * np.sin(TIMES), "near one": 1.0 + 1e-5 * np.sin(TIMES)}
    page = opened(Recording(None, TIMES, columns, {"strain": "m/m"}), plots=list(columns))
    for ticks in page("player.plots.charts.map(({ plot }) => plot.axes[1]._values)"):
        assert len(set(ticks)) == len(ticks) > 1
    assert "1e-6" in page("player.plots.charts[0].plot.axes[1]._values")


def test_instruments_of_a_small_picture_lie_beside_each_other_and_inside_of_it(opened):
    """Those for which there is no room are gone: below 130 pixels of height or 200 of width all of them."""
    run = moving_car.recording(TIMES)
    names = ("speed", *(f"used.{name}" for name in ("steering", "throttle", "brake", "hand_brake")))
    columns = dict(run.columns) | {name: np.full_like(TIMES, 0.5) for name in names}
    columns |= {f"wheel_{name}.Fz": np.full_like(TIMES, 3e3) for name in ("FL", "FR", "RL", "RR")}
    page = opened(Recording(run.scene, TIMES, columns))
    counts = {}
    for size in ((640, 420), (480, 400), (300, 420), (300, 260), (240, 200), (180, 400), (400, 160)):
        page.page.set_viewport_size({"width": size[0], "height": size[1]})
        page("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
        picture, *boxes = page(INSTRUMENTS)
        for k, one in enumerate(boxes):
            assert all(one[side] >= picture[side] for side in ("left", "top")), size
            assert all(one[side] <= picture[side] for side in ("right", "bottom")), size
            for other in boxes[:k]:
                beside = one["left"] >= other["right"] or other["left"] >= one["right"]
                assert beside or one["top"] >= other["bottom"] or other["top"] >= one["bottom"], size
        counts[size] = len(boxes)
    assert counts[640, 420] == 3, "tyres, map and cluster"
    assert counts[240, 200] == 1, "the cluster"
    assert counts[180, 400] == counts[400, 160] == 0


@pytest.mark.parametrize("count", [2, 6, 20])
def test_every_wheel_of_a_vehicle_is_in_the_diagram_of_its_tyres(opened, count):
    """Beside each other and inside of the diagram, which is inside of the picture."""
    run = crank(TIMES)
    columns = dict(run.columns) | {f"wheel_{k}.Fz": np.full_like(TIMES, 3e3) for k in range(count)}
    page = opened(Recording(run.scene, TIMES, columns, run.units, "lorry"), size=(1000, 560))
    page.seek(1.0)
    corners = "{ left, top, right, bottom }"
    boxes = f"(part) => {{ const {corners} = part.getBoundingClientRect(); return [left, top, right, bottom]; }}"
    wheels = np.array(page(f"[...document.querySelectorAll('.a3-tyres circle')].map({boxes})"))
    (panel,) = np.array(page(f"[...document.querySelectorAll('.a3-tyres')].map({boxes})"))
    assert len(wheels) == count
    assert np.all(wheels[:, 2:] - wheels[:, :2] > 5.0)
    assert np.all((wheels[:, :2] >= panel[:2]) & (wheels[:, 2:] <= panel[2:]))
    assert panel[1] > 0.0
    for k, one in enumerate(wheels):
        beside = (wheels[:k, :2] >= one[2:]) | (wheels[:k, 2:] <= one[:2])
        assert np.all(beside.any(axis=1))


def test_times_at_an_axis_do_not_run_into_each_other(opened):
    """A clock that counts from 1970, where consecutive ticks differ in the tenth digit; and the last of a long run."""
    late = opened(Recording(None, 1e9 + TIMES, {"x": np.sin(TIMES)}), plots=["x"])
    texts, places, font = late(
        """() => {
          const { axes, ctx } = player.plots.charts[0].plot;
          ctx.font = axes[0].font[0];
          const texts = axes[0]._values;
          return [texts, axes[0]._splits.map((x) => player.plots.charts[0].plot.valToPos(x, 'x', true)),
                  texts.map((text) => ctx.measureText(text).width)];
        }"""
    )
    assert len(set(texts)) == len(texts) > 1
    assert texts[0] == "1,000,000,000"
    assert np.all(np.diff(places) > np.add(font[1:], font[:-1]) / 2 + 4.0)
    long = opened(Recording(None, 1000.0 * TIMES / TIMES[-1], {"x": np.sin(TIMES)}), plots=["x"])
    text, right = long(
        """() => {
          const { plot } = player.plots.charts[0];
          plot.ctx.font = plot.axes[0].font[0];
          const half = plot.ctx.measureText(plot.axes[0]._values.at(-1)).width / 2;
          const right = plot.valToPos(plot.axes[0]._splits.at(-1), 'x', true) + half;
          return [plot.axes[0]._values.at(-1), right - plot.ctx.canvas.width];
        }"""
    )
    assert text == "1,000"
    assert right < 0.0


def test_diagrams_have_one_time_axis_however_wide_their_numbers_are(opened):
    """One instant is at one place in all diagrams, also after the numbers of one have changed their width."""
    columns = {"share": np.sin(TIMES), "force": 1e-7 * np.exp(10.0 * TIMES), "energy": 1e8 * TIMES}
    page = opened(Recording(None, TIMES, columns, {"force": "N", "energy": "J"}), plots=["share"])
    ends = "(part) => { const { left, right } = part.getBoundingClientRect(); return [left, right]; }"
    areas = f"[...document.querySelectorAll('.u-over')].map({ends})"
    widths = []
    for chosen in (["share"], ["share", "energy"], ["share", "force", "energy"], ["share", "force"]):
        page("names => player.plots.choose(names)", chosen)
        wait_until(page.page, "player.plots.charts.every(({ plot }) => plot.status === 1)")
        page("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
        found = np.array(page(areas))
        assert len(found) == len(chosen)
        assert np.ptp(found, axis=0).max() == 0.0, chosen
        widths.append(found[0, 1] - found[0, 0])
    assert widths[0] > widths[1] + 20.0, "wide numbers need room"


def test_a_printed_page_has_the_colours_of_its_legends(pair: Opened) -> None:
    """Browsers leave the backgrounds of elements out of print, unless told that they matter."""
    streams = re.findall(rb"stream\r?\n(.*?)\r?\nendstream", pair.page.pdf(), re.DOTALL)
    drawn = b"".join(zlib.decompress(part) for part in streams if part[:1] == b"x")
    fills = re.findall(rb"([\d.]+) ([\d.]+) ([\d.]+) rg", drawn)
    printed = {tuple(round(255 * float(part)) for part in colour) for colour in fills}
    background = "(part) => getComputedStyle(part).backgroundColor"
    swatches = pair(f"[...document.querySelectorAll('.a3-legend .a3-swatch')].map({background})")
    colours = {tuple(int(x) for x in re.findall(r"\d+", swatch)) for swatch in swatches if "rgba" not in swatch}
    assert len(colours) == 2, "that of the ghost is dashed"
    assert colours <= printed


def test_a_scene_that_cannot_be_drawn_shows_a_sentence_in_place_of_an_empty_page(pair):
    """Of another program: a flexible body without the numbers of its mode."""
    messages = pair(
        """async () => {
          const data = JSON.parse(document.getElementById('data').textContent);
          const [scene] = data.scenes;
          const [frame] = Object.keys(scene.frames);
          scene.flexible = [{ frame, nodes: [[0, 0, 0]], beams: [], amplitudes: ['angle'], modes: '' }];
          const place = document.body.appendChild(document.createElement('div'));
          const made = new ALi3Viewer.Player(place, data);
          await made.ready;
          place.remove();
          return [made.problem, place.textContent];
        }"""
    )
    assert messages == ["modes of a flexible body has 0 numbers, not 3.", f"This page cannot be shown: {messages[0]}"]


def test_without_webgl_there_is_one_sentence_and_the_diagrams(opened):
    page = opened(crank(TIMES), plots=["fx"], script=WITHOUT_WEBGL)
    assert "no WebGL" in page("player.problem")
    assert "no WebGL" in page.page.inner_text(".a3-view")
    page.seek(1.0)
    assert page.page.locator(".a3-chart").count() == 1
    assert [line for line in page.said if line.startswith("error")] == []


@pytest.mark.slow
def test_in_a_notebook_it_runs_in_its_frame(chromium, tmp_path):
    (tmp_path / "cell.html").write_text(f"<!DOCTYPE html><meta charset='utf-8'>{html_of(crank(TIMES), height=300)}")
    page = chromium.new_page(viewport={"width": 640, "height": 400})
    messages: list[str] = []
    page.on("console", lambda message: messages.append(message.text))
    page.on("pageerror", lambda error: messages.append(str(error)))
    page.goto((tmp_path / "cell.html").as_uri())
    frame = page.frames[1]
    wait_until(frame, "window.player !== undefined")
    assert frame.evaluate("async () => { await player.ready; await player.seek(1.5); return player.problem; }") == ""
    assert frame.evaluate("player.time") == 1.5
    frame.evaluate("player.pause()")
    assert [line for line in messages if "GL Driver" not in line] == []
    page.close()
