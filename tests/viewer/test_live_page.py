"""Pages that run an FMU, opened from disk in a Chromium without a window, against the same FMU run natively."""

import base64
import csv
import json
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hosts.fmu.fmu import Fmu
from hosts.fmu.geometry import scene_of
from hosts.run.command import main as run
from hosts.view import page_parts
from hosts.view.command import main as view
from tests.in_browser import SELDOM, wait_text, wait_until

STEP = 0.002


@pytest.fixture(scope="module", autouse=True)
def _roads_once() -> Iterator[None]:
    """Each road of an FMU is read in a program of its own: of the same FMU not again for each page."""
    known: dict[tuple[Any, ...], Any] = {}

    def once(fmu: Path, settings: Mapping[str, Any]) -> Any:
        key = (fmu, *sorted(settings.items()))
        if key not in known:
            known[key] = scene_of(fmu, settings)
        return known[key]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(page_parts, "scene_of", once)
        yield


class Page:
    """A page that is open; what went wrong in it is in `wrong`."""

    def __init__(self, browser: Any, file: Path, script: str = "") -> None:
        self.wrong: list[str] = []
        self.context = browser.new_context(viewport={"width": 640, "height": 360})
        self.page = self.context.new_page()
        self.page.set_default_timeout(60_000)
        self.page.on("console", lambda m: m.type in ("error", "warning") and self.wrong.append(m.text))
        self.page.on("pageerror", lambda e: self.wrong.append(str(e)))
        self.page.on("request", self._asked)
        self.page.add_init_script(SELDOM + script)
        self.page.goto(file.resolve().as_uri())
        self.ask("player.ready.catch(() => {})")

    def _asked(self, request: Any) -> None:
        if not request.url.startswith(("file:", "blob:", "data:")):
            self.wrong.append(request.url)

    def ask(self, expression: str) -> Any:
        return self.page.evaluate(f"async () => await ({expression})")

    def get(self, *names: str) -> list[float]:
        return list(self.ask(f"{json.dumps(names)}.map((name) => player.get(name))"))

    def text(self, what: str) -> str:
        return str(self.page.locator(f'[data-a3="{what}"]').first.inner_text())

    def until(self, expression: str) -> None:
        wait_until(self.page, expression)

    def focused(self) -> str:
        """Name of the part with the focus, which a browser takes from a hidden one when it draws."""
        self.ask("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
        return str(self.ask("document.activeElement.dataset.a3"))

    def close(self) -> None:
        self.context.close()


def written(fmus: list[Path], out: Path, *more: str) -> Path:
    assert view(["--live", "--no-open", *map(str, fmus), "--out", str(out), *more]) == 0
    return next(out.glob("*.html"))


def columns(text: str) -> dict[str, np.ndarray[Any, Any]]:
    rows = list(csv.reader(line for line in text.splitlines() if not line.startswith("#")))
    return dict(zip(rows[0], np.array(rows[1:], dtype=float).T, strict=True))


def replayed(fmu: Path, table: str, folder: Path) -> dict[str, np.ndarray[Any, Any]]:
    """What the native FMU gives for the inputs of a table that a page has written."""
    file = folder / "recorded.csv"
    file.write_text(table, encoding="utf-8")
    assert run([str(fmu), "--input", str(file), "--out", str(folder / "replay")]) == 0
    return columns(next((folder / "replay").glob("*_recorded.csv")).read_text(encoding="utf-8"))


def assert_same_bits(fmu: Path, table: str, folder: Path) -> None:
    seen, native = columns(table), replayed(fmu, table, folder)
    with Fmu(fmu) as read:
        outputs = read.names("output")
    assert len(seen["time"]) == len(native["time"])
    assert [n for n in ("time", *outputs) if seen[n].tobytes() != native[n].tobytes()] == []


@pytest.mark.slow
def test_the_car_is_driven_by_keys_in_real_time_and_its_table_runs_natively_to_the_same_bits(
    live_car, chromium, tmp_path
):
    opened = Page(chromium, written([live_car], tmp_path, "--title", "A <car> & its page"))
    assert opened.page.title() == "A <car> & its page"
    keyboard = opened.page.keyboard
    keyboard.down("ArrowUp")
    opened.until("player.time > 0.6")
    keyboard.down("KeyA")
    opened.until("player.get('used.steering') > 0.05 && player.get('speed') > 1")
    keyboard.up("KeyA")
    keyboard.up("ArrowUp")
    keyboard.down("Space")
    opened.until("player.get('used.hand_brake') === 1 && player.get('used.steering') === 0")
    keyboard.up("Space")
    wait_text(opened.page, "cluster", "km/h")
    wait_text(opened.page, "pace", "real time (×")
    keyboard.press("k")
    wait_text(opened.page, "step time", " of 2.00 ms")
    keyboard.press("p")
    opened.until("!player.running")
    keyboard.press("r")
    opened.ask("player.advance(10)")
    assert opened.get("selector", "used.selector") == [-1.0, -1.0]
    table = opened.ask("player.csv()")
    assert np.unwrap(columns(table)["chassis.yaw"])[-1] > 0.0  # to the left, however long it took
    rates = np.abs(np.diff(columns(table)["throttle"])) / STEP
    assert 0.0 < rates.max() < 5.0 + 1e-6  # pedals move, they do not jump
    assert_same_bits(live_car, table, tmp_path)
    assert opened.wrong == []
    opened.close()


@pytest.mark.slow
def test_parameters_start_values_and_going_back_give_the_bits_of_a_native_run(live_car, chromium, tmp_path):
    opened = Page(chromium, written([live_car], tmp_path, "--set", "initial.yaw=0.1", "--paused"))
    assert opened.ask("player.running") is False
    opened.ask("player.set('initial.speed', 12)")
    assert opened.ask("player.time") == 0.0
    opened.ask("player.set('throttle', 0.4)")
    opened.ask("player.advance(400)")
    opened.ask("player.set('road.friction', 0.5)")
    opened.ask("player.set('steering', 0.4)")
    opened.ask("player.advance(400)")
    before = opened.ask("[...player.session.record.row(617)]")
    opened.ask("player.seek(1.234)")
    assert opened.ask("player.session.scrubbed") == 1.234
    opened.ask("player.advance(50)")  # from there
    assert abs(opened.ask("player.time") - 1.334) < 1e-9
    assert opened.ask("[...player.session.record.row(617)]") == before
    opened.ask("player.set('brake', 0.6)")
    opened.ask("player.advance(100)")
    table = opened.ask("player.csv()")
    assert "# start: initial.yaw=0.1, initial.speed=12" in table
    assert {"road.friction"} == set(columns(table)) & {"road.friction", "front.spring.stiffness"}
    assert set(columns(table)["road.friction"]) > {0.5}
    assert_same_bits(live_car, table, tmp_path)
    opened.ask("player.reset()")
    assert opened.ask("player.time") == 0.0
    assert opened.get("speed") == pytest.approx([12.0])
    assert opened.wrong == []
    opened.close()


PAD = """
window.pad = {id: "a wheel", mapping: "standard", connected: true, axes: [0, 0],
              buttons: Array.from({length: 16}, () => ({value: 0, pressed: false}))};
window.pads = [];
navigator.getGamepads = () => window.pads;
"""


@pytest.mark.slow
def test_a_gamepad_is_plugged_in_and_drives(live_car, chromium, tmp_path):
    opened = Page(chromium, written([live_car], tmp_path), PAD)
    opened.page.locator('[data-a3="section Gamepad"] summary').click()
    assert "No gamepad" in opened.text("section Gamepad")
    opened.ask("(pads.push(pad), 1)")
    opened.until("document.querySelector('[data-a3=\"gamepad\"]')?.textContent === 'a wheel'")
    opened.ask("(pad.buttons[7] = {value: 0.5}, pad.axes = [-0.54, 0], 1)")
    opened.until("player.get('used.throttle') === 0.5")
    assert opened.get("steering")[0] == pytest.approx((0.54 - 0.08) / 0.92)
    opened.until("document.querySelector('[data-a3=\"axes\"]').textContent.startsWith('axis 0: -0.54')")
    opened.page.locator('[data-a3="assign brake"]').select_option("button 3")
    opened.ask("(pad.buttons[3] = {value: 1}, 1)")
    opened.until("player.get('used.brake') === 1")
    opened.ask("(pads.length = 0, 1)")
    opened.until("document.querySelector('[data-a3=\"section Gamepad\"]').textContent.includes('No gamepad')")
    assert opened.wrong == []
    opened.close()


@pytest.mark.slow
def test_sliders_of_a_mechanism_and_a_step_that_is_refused(live_reach, chromium, tmp_path):
    opened = Page(chromium, written([live_reach], tmp_path, "--paused", "--step", "0.01", "--plot", "bob.x"))
    assert opened.page.locator(".a3-chart canvas").count() == 1
    opened.page.locator('[data-a3="control pull"] [data-a3="number"]').fill("0.2")
    opened.page.keyboard.press("Tab")
    opened.ask("player.advance(30)")
    assert opened.get("pull", "pull_used") == [0.2, 0.2]
    opened.page.locator('[data-a3="section Parameters"] > summary').click()
    opened.page.locator('[data-a3="section spring"] > summary').click()
    field = opened.page.locator('[data-a3="control spring.stiffness"] [data-a3="number"]')
    field.fill("500")  # beyond its range
    opened.page.keyboard.press("Tab")
    opened.ask("(player.draw(), 1)")
    assert (field.input_value(), field.get_attribute("aria-invalid")) == ("500", "true")
    field.fill("20")
    opened.page.keyboard.press("Tab")
    assert field.get_attribute("aria-invalid") == "false"
    opened.ask("player.advance(30)")
    table = opened.ask("player.csv()")
    assert columns(table)["spring.stiffness"].tolist() == [5.0] * 30 + [20.0] * 31
    assert_same_bits(live_reach, table, tmp_path)
    field = opened.page.locator('[data-a3="control spring.free_length"] [data-a3="number"]')
    field.fill("0.3")
    opened.page.keyboard.press("Tab")
    opened.until("player.time === 0 && player.session.start['spring.free_length'] === 0.3")
    wait_text(opened.page, "events", "began again with spring.free_length = 0.3")
    opened.ask("player.advance(20)")
    assert "spring.free_length=0.3" in opened.ask("player.csv()")
    assert_same_bits(live_reach, opened.ask("player.csv()"), tmp_path)

    opened.ask("player.set('pull', 5)")
    opened.ask("player.advance(300)")
    message = opened.text("flag stopped 0")
    assert message.startswith("Stopped at 0.")
    assert "refused" in message
    assert "step_size" in message
    at = opened.ask("player.time")
    assert_same_bits(live_reach, opened.ask("player.csv()"), tmp_path)
    opened.page.locator('[data-a3="go back"]').focus()
    opened.page.keyboard.press("Enter")
    opened.until("player.time === 0")
    assert at > 0.2
    assert not opened.page.locator('[data-a3="flag stopped 0"]').is_visible()
    assert opened.focused() == "toggle", "the button that had the focus is gone"
    opened.ask("player.advance(5)")
    opened.page.locator('[data-a3="rewind"]').focus()
    opened.page.keyboard.press("Enter")
    opened.until("player.time === 0")
    assert opened.focused() == "rewind", "though there is nothing left to go back to"
    opened.ask("player.set('pull', 0)")
    opened.ask("player.advance(100)")
    assert opened.ask("player.time") == pytest.approx(1.0)
    assert opened.wrong == []
    opened.close()


@pytest.mark.slow
def test_an_fmu_that_cannot_start_is_reported_at_each_attempt(live_reach, chromium, tmp_path):
    """One starts outside of the reach of its cable, the binary of the other is none."""
    far = written([live_reach], tmp_path / "far", "--set", "pull=9")
    text = written([live_reach], tmp_path / "binary").read_text(encoding="utf-8")
    spoilt = tmp_path / "spoilt.html"
    binary = base64.b64encode(b"no module").decode()
    spoilt.write_text(re.sub(r'"wasm":"[^"]*"', f'"wasm":"{binary}"', text), encoding="utf-8")
    for file in (far, spoilt):
        opened = Page(chromium, file)
        message = opened.text("flag problem")
        assert message.startswith("The FMU could not be started: ")
        assert opened.page.locator('[data-a3="flag problem"]').get_attribute("role") == "alert"
        assert opened.page.locator("canvas").count() > 0, "it is drawn as it was built"
        opened.close()


@pytest.mark.slow
def test_a_table_moves_inputs_until_a_hand_does_and_a_result_goes_along(live_reach, chromium, tmp_path):
    table = tmp_path / "pulled.csv"
    table.write_text('"time","pull"\n0,0.1\n0.5,0.3\n0.5,0.2\n1,0.2\n# start: spring.free_length=0.25\n')
    assert run([str(live_reach), "--input", str(table), "--step", "0.01", "--out", str(tmp_path)]) == 0
    more = ["--paused", "--step", "0.01", "--manoeuvre", str(table)]
    result = next(tmp_path.glob("*_pulled.csv"))
    opened = Page(chromium, written([live_reach, result], tmp_path / "page", *more))
    assert "follow a table of 1 s" in opened.text("section Inputs")
    assert opened.page.locator(".a3-view canvas").count() == 2
    opened.ask("player.advance(60)")
    beside = opened.ask("player.stage.parts[1].sample(player.time)('bob.x')")
    # A page holds the value of its table over each step, half a step late; the command follows the line.
    assert opened.get("bob.x")[0] == pytest.approx(beside, abs=5e-4)
    assert_same_bits(live_reach, opened.ask("player.csv()"), tmp_path)
    assert columns(opened.ask("player.csv()"))["pull"][[0, 25, 50]].tolist() == [0.1, 0.2, 0.2]
    opened.ask("player.set('pull', 0.4)")
    opened.ask("player.advance(60)")
    assert opened.get("pull_used") == [0.4]
    ended = opened.page.locator('[data-a3^="flag end"]')
    assert ended.inner_text().endswith("(recorded): The recording ends at 1 s.")
    assert_same_bits(live_reach, opened.ask("player.csv()"), tmp_path)
    opened.ask("player.reset()")
    assert opened.get("pull") == [0.1]
    assert not ended.is_visible()
    assert opened.wrong == []
    opened.close()


@pytest.mark.slow
def test_levers_drive_and_a_hidden_page_stands(live_car, chromium, tmp_path):
    opened = Page(chromium, written([live_car], tmp_path))
    opened.page.locator('[data-a3="levers"]').click()
    levers = [f'[data-a3="lever {name}"]' for name in ("steering", "brake", "throttle")]
    for width, height in ((320, 256), (390, 844), (844, 390), (800, 600)):
        opened.page.set_viewport_size({"width": width, "height": height})
        assert opened.page.locator(".a3-view").bounding_box()["width"] >= 160, "beside the panel"
        if height < 300:  # 1280 x 1024 pixels at a zoom of 400 %
            continue
        parts = (".a3-timing", ".a3-cluster", *levers)
        opened.page.locator(".a3-cluster").wait_for()  # shown again behind the smallest picture
        figures, *boxes = (opened.page.locator(part).bounding_box() for part in parts)
        beside = [figures["x"] + figures["width"] <= box["x"] for box in boxes]
        above = [figures["y"] + figures["height"] <= box["y"] for box in boxes]
        below = [figures["y"] >= box["y"] + box["height"] for box in boxes]
        assert all(np.logical_or.reduce([beside, above, below])), "figures can be read beside levers"
    throttle = opened.page.locator('[data-a3="lever throttle"]')
    box = throttle.bounding_box()
    throttle.hover(position={"x": box["width"] / 2, "y": box["height"] * 0.25})  # waits until the layout rests
    opened.page.mouse.down()
    opened.until("player.get('used.throttle') > 0.7 && player.get('used.throttle') < 0.8")
    opened.page.mouse.up()
    opened.until("player.get('used.throttle') === 0")
    opened.ask(
        "(Object.defineProperty(document, 'hidden', {value: true}),"
        " document.dispatchEvent(new Event('visibilitychange')))"
    )
    assert opened.ask("player.running") is False
    assert opened.text("flag hidden") == "Paused, because the page was not on the screen."
    before = opened.ask("player.session.pause().then(() => player.time)")
    opened.page.keyboard.press(".")
    opened.until(f"player.time > {before}")
    assert opened.ask("player.time") == pytest.approx(before + STEP)
    assert opened.wrong == []
    opened.close()


@pytest.mark.slow
def test_a_road_of_the_user_is_in_the_page_and_under_the_car(live_car, chromium, tmp_path):
    bumps = tmp_path / "bumps.toml"
    bumps.write_text(
        'kind = "washboard"\nstart = 5.0\nlength = 40.0\nwidth = 6.0\namplitude = 0.02\nwavelength = 1.0\n'
    )
    more = ["--paused", "--road", str(bumps), "--set", "initial.speed=10"]
    opened = Page(chromium, written([live_car], tmp_path / "page", *more))
    assert opened.ask("player.session.start['road.file']") == "bumps.road"
    assert opened.ask("player.view.scene.roads.map((road) => road.kind)") == ["grid"]
    opened.ask("player.advance(500)")
    rough = opened.ask("player.session.record.series(player.session.record.column('chassis.az'), 100, 1)[1]")
    assert np.ptp(rough) > 1.0
    assert opened.ask("player.set('road.file', '').then(() => player.view.scene.roads[0].kind)") == "profile"
    opened.ask("player.advance(500)")
    level = opened.ask("player.session.record.series(player.session.record.column('chassis.az'), 100, 1)[1]")
    assert np.ptp(level) < 0.5
    opened.ask("player.advance(503)")  # more rows than a curve has points
    beside = opened.page.locator(".a3-legend output").first.inner_text()
    assert float(beside.split()[0]) == pytest.approx(opened.get("speed")[0], rel=1e-4)
    opened.ask("player.set('road.kerb_height', 0.2)")
    opened.ask("player.advance(1)")
    assert opened.ask("player.view.scene.roads[0].heights") == [0.0, -0.2]
    drawn = scene_of(live_car, {"road.kerb_height": 0.2})
    assert drawn is not None
    assert drawn["roads"][0]["heights"] == [0.0, -0.2]  # the car stands on the upper level, at 0
    assert opened.wrong == []
    opened.close()
