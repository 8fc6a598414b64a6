"""The page of the simulator in a Chromium without a window, against frames that the test sends."""

from collections.abc import Iterator
from itertools import combinations
from typing import Any
from unittest.mock import ANY

import numpy as np
import pytest

from ali3.scene.recording import Recording
from tests.in_browser import WITHOUT_WEBGL, picture_of_simulator, wait_drawn, wait_text, wait_until
from tests.viewer.simulator_program import BEHIND, REFUSED, REPORT, RUNNING, Program

PLACES = [{"name": "start", "x": 0.0, "y": -60.0, "yaw": 0.0}, {"name": "hill_20", "x": 120.0, "y": 80.0, "yaw": 0.0}]
WORLD = {"name": "here", "places": PLACES, "bounds": [-200.0, -200.0, 200.0, 200.0]}
PARTS = ("bar", "timing", "tyres", "map inset", "cluster")
_BOXES = """names => Object.fromEntries(names.map(name => {
  const { left, top, right, bottom } = document.querySelector(`[data-a3="${name}"]`).getBoundingClientRect();
  return [name, [left, top, right, bottom]];
}).filter(([, [left, , right]]) => right > left))"""
_HIDE = """() => {
  Object.defineProperty(document, 'hidden', {value: true, configurable: true});
  document.dispatchEvent(new Event('visibilitychange'));
}"""


@pytest.fixture
def program(chromium: Any, lane_change: Recording) -> Iterator[Program]:
    """The page, open; an error in its script fails the test."""
    context = chromium.new_context(viewport={"width": 640, "height": 360})
    opened = Program(context.new_page(), lane_change, world=WORLD)
    opened.open()
    yield opened
    context.close()
    assert opened.errors == []


def shown(program: Program, time: float, flags: int = 0, **header: float) -> None:
    """A frame of a car that stands at a time of the run, drawn."""
    program.send(time, flags, **header)
    wait_until(
        program.page, "count => player.frames.newest?.count === count", arg=round(time / 0.002) + 1e6 * program.epoch
    )
    wait_drawn(program.page)


def at(recording: Recording, name: str, time: float) -> float:
    return float(np.interp(time, recording.t, recording.columns[name]))


def test_keys_drive_at_their_rates_and_are_let_go_with_the_focus(program):
    shown(program, 0.5, RUNNING)
    keyboard = program.page.keyboard
    keyboard.down("ArrowUp")
    program.until_wanted(throttle=[1, 2.5])
    keyboard.down("Control")
    keyboard.up("ArrowUp")  # let go also while another key is held
    program.until_wanted(throttle=[0, 5])
    keyboard.up("Control")
    keyboard.down("ArrowUp")
    keyboard.down("KeyA")
    program.until_wanted(throttle=[1, 2.5], steering=[ANY, 1.6])
    assert {m["source"] for m in program.heard if m["type"] == "want"} == {"keys"}
    assert program.wanted()["steering"][0] > 0.02  # to the left
    program.page.evaluate("window.dispatchEvent(new Event('blur'))")
    program.until_wanted(throttle=[0, 5], steering=[0, 3])
    keyboard.up("ArrowUp")
    keyboard.up("KeyA")
    keyboard.down("Space")
    program.until_wanted(hand_brake=[1, 8])
    program.page.evaluate(_HIDE)
    program.until_wanted(hand_brake=[0, 8])
    keyboard.up("Space")
    keyboard.press("r")
    program.until_wanted(selector=[-1, None])


@pytest.mark.slow
def test_what_is_true_of_the_run_stands_over_the_picture(program):
    flag = lambda name: program.page.locator(f'[data-a3="flag {name}"]')  # noqa: E731
    shown(program, 2.0, 0)
    assert flag("paused").is_visible()
    shown(program, 2.1, RUNNING, speed=0.25, deadline=0.008)
    assert not flag("paused").is_visible()
    assert program.text("flag slow") == "slow motion × 0.25"
    program.say({"type": "event", "kind": "refused", "time": 2.15, "text": "The step did not converge."})
    shown(program, 2.15, RUNNING)  # from before the refusal, sent after its sentence
    shown(program, 2.15, REFUSED)
    wait_until(program.page, "!document.querySelector('[data-a3=\"flag refused\"]').hidden")
    assert program.text("flag refused").startswith("The step did not converge. Rewind")
    program.epoch = 2  # a rewind
    shown(program, 2.0, RUNNING)
    assert not flag("refused").is_visible()
    shown(program, 2.2, REFUSED)
    assert program.text("flag refused").startswith("The car refused a step. Rewind")  # not the sentence of the other
    shown(program, 2.3, RUNNING | BEHIND)
    assert not flag("refused").is_visible()
    assert "behind" in program.text("flag behind")
    assert not flag("outside").is_visible()
    scene = program.recording.scene or {}
    program.values = {scene["frames"][scene["focus"]]["position"][0]: 250.0}
    shown(program, 2.4, RUNNING)
    assert "Outside of the world" in program.text("flag outside")
    program.say({"type": "event", "kind": "told", "time": 2.3, "text": "Page 2 was closed: throttle let go."})
    program.say({"type": "refused", "text": "There is no command 'fly'."})
    wait_text(program.page, "events", "throttle let go.")
    wait_text(program.page, "events", "There is no command 'fly'.")
    wait_until(program.page, "!document.querySelector('[data-a3=\"flag stalled\"]')?.hidden === true")
    assert "this is the last that came" in program.text("flag stalled")


@pytest.mark.slow
def test_a_broken_wire_is_reported_and_mended_and_a_world_that_comes_then_is_no_longer_missed(program):
    page, message = program.page, "The drawing of the world cannot be had"
    lost = "document.querySelector('[data-a3=\"flag lost\"]')?.textContent || ''"
    shown(program, 1.0, RUNNING)
    page.route("**/world*", lambda route: route.fulfill(status=500), times=1)
    for missed in (True, False):
        page.evaluate("window.before = player.cockpit")
        program.sockets[-1].close()
        assert "Trying again" in wait_until(page, lost)
        wait_until(page, f"player.cockpit !== window.before && !({lost})")
        assert (message in program.text("events")) is missed
    assert len(program.sockets) == 3
    program.epoch = 2
    shown(program, 0.5, RUNNING)
    assert int(program.text("speed")) > 0
    program.errors.clear()  # the browser tells of the answer too


@pytest.mark.slow
def test_the_page_of_a_car_that_comes_back_keeps_its_settings_and_the_focus(program):
    """It is another program, which counts its frames and epochs anew and records in another file."""
    page = program.page
    shown(program, 2.0, RUNNING)
    page.evaluate("window.before = player.cockpit; before.side(true); before.setLook({ arrowScale: 2 })")
    page.keyboard.press("Tab")
    page.locator("[data-a3=settings]").focus()
    program.hello["recording"] = "again.npz"
    program.count, program.epoch = 0, 0
    program.sockets[-1].close()
    wait_text(page, "recording", "again.npz")
    assert page.evaluate("[player.cockpit === before, before.look.arrowScale, document.activeElement.dataset.a3]") == [
        True,
        2,
        "settings",
    ]
    watched = [message["on"] for message in program.heard if message["type"] == "watch devices"]
    assert watched[-2:] == [True, True]
    shown(program, 0.5, RUNNING)
    assert page.evaluate("player.cockpit.source.time") == pytest.approx(0.5)


@pytest.mark.slow
def test_the_car_is_drawn_at_its_frame_in_every_camera(chromium, lane_change):
    """Points inside the wheels, which are magenta here."""
    scene = dict(lane_change.scene or {})
    scene["shapes"] = [s | {"color": "#ff00ff", "material": "plastic"} for s in scene["shapes"] if s["kind"] == "wheel"]
    scene["shapes"] = [
        {"kind": "sphere", "frame": s["frame"], "radius": s["radius"], "color": "#ff00ff"} for s in scene["shapes"]
    ]
    context = chromium.new_context(viewport={"width": 640, "height": 360})
    program = Program(context.new_page(), Recording(scene, lane_change.t, lane_change.columns), world=WORLD)
    program.open()
    for camera in ("chase", "top"):
        assert program.page.evaluate("name => player.camera(name)", camera) == ""
        program.epoch += 1
        for time in (2.0, 4.5):
            shown(program, time)
            pixels = picture_of_simulator(program.page)
            r, g, b = (pixels[..., k] for k in range(3))
            seen = (r > g + 25) & (b > g + 25)
            for wheel in ("FL", "FR", "RL", "RR"):
                point = [at(lane_change, f"wheel_{wheel}.{c}", time) for c in "xyz"]
                x, y = program.page.evaluate("point => player.view.project(point)", point)
                assert seen[int(y) - 2 : int(y) + 3, int(x) - 2 : int(x) + 3].any(), f"{camera}, {time} s, {wheel}"
            assert not seen[:40].any(), "something is drawn in the sky"
    assert program.errors == []
    context.close()


@pytest.mark.slow
@pytest.mark.parametrize("without", ["a drawing", "WebGL"])
def test_instruments_map_and_keys_work_without_a_picture(chromium, lane_change, without):
    context = chromium.new_context(viewport={"width": 640, "height": 360})
    page = context.new_page()
    if without == "WebGL":
        page.add_init_script(WITHOUT_WEBGL)
    scene = lane_change.scene if without == "WebGL" else None
    program = Program(page, Recording(scene, lane_change.t, lane_change.columns), world=WORLD)
    if scene is None:
        program.hello["scene"] = None
    program.open()
    shown(program, 3.0, RUNNING)
    assert int(program.text("speed")) == round(3.6 * at(lane_change, "speed", 3.0))
    if without == "WebGL":
        assert "no WebGL" in program.ask("player.problem")
    assert program.ask("player.cockpit.cameraName") == "map"
    page.keyboard.press("p")
    shown(program, 3.1, RUNNING)
    assert ("pause", 0) in program.commands()
    x, y = page.evaluate(
        "point => player.cockpit.map.pixel(point)", [at(lane_change, f"chassis.{c}", 3.1) for c in "xy"]
    )
    assert np.allclose(picture_of_simulator(program.page)[int(y), int(x)], [229, 53, 43], atol=30)
    assert program.errors == []
    context.close()


@pytest.mark.slow
@pytest.mark.parametrize(
    "sizes",
    [[(1280, 720)], [(1280, 720), (800, 1280)], [(390, 844), (844, 390)]],
    ids=["screen", "tablet", "telephone"],
)
def test_everything_fits_on_the_screen_and_nothing_lies_on_another(chromium, lane_change, sizes):
    """A tablet and a telephone have levers to touch, and are turned; a key shows and hides levers everywhere."""
    levers = [f"lever {name}" for name in ("steering", "brake", "throttle")]
    context = chromium.new_context(viewport={"width": sizes[0][0], "height": sizes[0][1]}, has_touch=len(sizes) > 1)
    program = Program(context.new_page(), lane_change, world=WORLD)
    program.open()
    has_levers = len(sizes) > 1
    for turned, (width, height) in enumerate([*sizes, sizes[0]]):
        program.page.set_viewport_size({"width": width, "height": height})
        if turned == len(sizes):
            program.page.keyboard.press("t")
            has_levers = not has_levers
        shown(program, 2.0 + turned)
        boxes = program.page.evaluate(_BOXES, [*PARTS, *levers])
        assert set(boxes) == {*PARTS, *(levers if has_levers else ())}
        assert program.page.locator("[data-a3=levers]").get_attribute("aria-pressed") == str(has_levers).lower()
        for name, (left, top, right, bottom) in boxes.items():
            assert min(left, top) >= 0, name
            assert right <= width + 0.5, name
            assert bottom <= height + 0.5, name
        for (a, (l1, t1, r1, b1)), (b, (l2, t2, r2, b2)) in combinations(boxes.items(), 2):
            assert r1 <= l2 + 0.5 or r2 <= l1 + 0.5 or b1 <= t2 + 0.5 or b2 <= t1 + 0.5, f"{a} lies on {b}"
    assert program.errors == []
    context.close()


@pytest.mark.slow
def test_long_sentences_beside_open_panels_end_above_the_cluster(chromium, lane_change):
    context = chromium.new_context(viewport={"width": 800, "height": 450})
    program = Program(context.new_page(), lane_change, world=WORLD)
    program.open()
    shown(program, 2.0)
    program.page.keyboard.press("g")
    for text in ("first", "second", "newest"):
        program.say(
            {"type": "event", "kind": "told", "time": 2.0, "text": f"The {text} sentence" + 20 * " is long" + "."}
        )
    wait_until(program.page, "document.querySelector('.a3-events').textContent.includes('newest')")
    boxes = program.page.evaluate(_BOXES, ["cluster", "tyres"])
    notices = program.page.evaluate("() => document.querySelector('.a3-notices').getBoundingClientRect().toJSON()")
    newest = program.page.evaluate(
        "() => document.querySelector('.a3-events > div:last-child').getBoundingClientRect().toJSON()"
    )
    assert notices["bottom"] <= boxes["cluster"][1]
    assert notices["left"] >= boxes["tyres"][2]
    assert 0 <= notices["top"] <= 20
    assert notices["top"] <= newest["top"] < newest["top"] + 40 <= notices["bottom"]
    assert program.errors == []
    context.close()


@pytest.fixture(scope="class")
def _open_page(chromium: Any, lane_change: Recording) -> Iterator[Program]:
    context = chromium.new_context(viewport={"width": 640, "height": 360})
    program = Program(context.new_page(), lane_change, world=WORLD)
    program.open()
    yield program
    context.close()


@pytest.fixture
def reused(_open_page: Program) -> Iterator[Program]:
    _open_page.heard.clear()
    _open_page.values = {}
    _open_page.epoch += 1
    _open_page.page.keyboard.press("1")  # the camera of a test that failed may have stayed
    yield _open_page
    assert _open_page.errors == []


class TestOnePage:
    """Tests that leave the page as it was share one, each with an epoch of its own; it is closed before others open."""

    def test_instruments_show_the_numbers_of_the_frame(self, reused, lane_change):
        reused.values = {"used.throttle": 0.25, "used.brake": 0.5, "used.selector": 1.0}
        assert not reused.page.locator('[data-a3="step time"]').is_visible()
        reused.page.keyboard.press("k")
        shown(reused, 5.0, RUNNING, cost=1e-3, worst=1.5e-3, missed=7)
        assert int(reused.text("speed")) == round(3.6 * at(lane_change, "speed", 5.0))
        assert reused.text("gear") == f"gear {at(lane_change, 'gear', 5.0):.0f}"
        rpm = 30 / np.pi * at(lane_change, "engine_speed", 5.0)
        assert reused.text("revolutions") == f"{rpm:.0f} rpm"
        value = "name => player.cockpit.instruments.cluster._pedals.find(p => p.column === `used.${name}`).gauge.value"
        assert reused.page.evaluate(value, "throttle") == 0.25
        assert reused.page.evaluate(value, "brake") == 0.5
        assert reused.ask("player.cockpit.timing._bar.value") == pytest.approx(0.5)
        assert "missed 7" in reused.text("missed")
        assert "1.00 ms of 2.00 ms" in reused.text("step time")
        wheels = ["FL", "FR", "RL", "RR"]
        forces = {w: [at(lane_change, f"wheel_{w}.{c}", 5.0) for c in ("Fx", "Fy", "Fz")] for w in wheels}
        uses = reused.ask("player.cockpit.instruments.tyres.uses")
        for w, (fx, fy, fz) in forces.items():
            assert uses[f"wheel_{w}"] == pytest.approx(np.hypot(fx, fy) / fz, rel=0.02)
        radii = [
            float(r)
            for r in reused.ask("[...document.querySelectorAll('.a3-tyres circle')].map(c => c.getAttribute('r'))")
        ]
        loads = np.array([forces[w][2] for w in wheels])
        message = reused.ask("[...document.querySelectorAll('.a3-tyres text')].map(t => t.textContent)")
        assert message[::2] == [f"{forces[w][2] / 1e3:.1f} kN" for w in wheels]
        slips = [100 * at(lane_change, f"wheel_{w}.slip", 5.0) for w in wheels]
        assert [float(word.split()[0]) for word in message[1::2]] == pytest.approx(slips, abs=0.51)
        assert np.array(radii) / max(radii) == pytest.approx(np.sqrt(loads / loads.max()), abs=0.01)

    def test_an_arrow_of_a_tyre_points_where_the_force_does(self, reused):
        names = ("Fx", "Fy", "steer")
        reused.values = {f"wheel_{w}.{c}": 0.0 for w in ("FL", "FR", "RL", "RR") for c in names}
        reused.values |= {f"wheel_{w}.Fz": 2000.0 for w in ("FL", "FR", "RL", "RR")}
        reused.values |= {"wheel_FL.Fy": 1500.0, "wheel_RR.Fx": -1500.0}  # to the left; braked
        shown(reused, 1.0)
        paths = reused.ask("[...document.querySelectorAll('.a3-tyres path:last-of-type')].length && "
                            "player.cockpit.instruments.tyres._items.map(i => i.arrow.getAttribute('d'))")  # fmt: skip
        assert paths[1] == paths[2] == ""
        ends = {k: [float(x) for x in paths[k].split("L")[1].split("M")[0].split()] for k in (0, 3)}
        begins = {k: [float(x) for x in paths[k][1:].split("L")[0].split()] for k in (0, 3)}
        assert ends[0][0] < begins[0][0] - 8
        assert ends[0][1] == pytest.approx(begins[0][1], abs=0.11)
        assert ends[3][1] > begins[3][1] + 8  # down is backwards
        assert ends[3][0] == pytest.approx(begins[3][0], abs=0.11)

    def test_keys_and_buttons_are_commands(self, reused):
        shown(reused, 3.0, RUNNING, saved=12.5)
        keyboard = reused.page.keyboard
        for key in ("p", ".", "Backspace", "Shift+Backspace", "u", "Home", "l"):
            keyboard.press(key)
        click = lambda what: reused.page.locator(f'[data-a3="{what}"]').first.click()  # noqa: E731
        click("rewind")
        reused.page.locator('[data-a3="timeline"]').evaluate(
            "slider => { slider.value = slider.max - 7.5;"
            " for (const e of ['input', 'change']) slider.dispatchEvent(new Event(e)); }"
        )
        reused.page.locator('[data-a3="place"]').select_option("hill_20")
        reused.until_heard({"type": "place", "name": "hill_20"})
        names = ["pause", "step", "rewind", "rewind", "upright", "reset", "speed", "rewind", "rewind"]
        values = [0, 1, 2, 10, 0, 0, 0.25, 2, 7.5]
        assert reused.commands() == list(zip(names, values, strict=True))
        assert reused.ask("['max', 'min'].map(end => Number(document.querySelector('.a3-slide')[end]))") == [3, -9.5]
        keyboard.press("h")
        assert reused.page.locator('[data-a3="help list"]').is_visible()
        keyboard.press("h")
        assert not reused.page.locator('[data-a3="help list"]').is_visible()

    def test_the_map_shows_the_car_its_trail_and_places(self, reused, lane_change):
        for time in np.arange(0.0, 3.0, 0.2):  # each drawn: frames in real time pass a page that has no processor
            shown(reused, time)
        reused.page.keyboard.press("5")
        shown(reused, 3.0)
        pixels = picture_of_simulator(reused.page)
        where = [at(lane_change, f"chassis.{c}", 3.0) for c in "xy"]
        x, y = reused.page.evaluate("point => player.cockpit.map.pixel(point)", where)
        assert np.allclose(pixels[int(y), int(x)], [229, 53, 43], atol=30)  # the car
        assert x > 320  # it went along x, which is to the right
        past = [at(lane_change, f"chassis.{c}", 0.8) for c in "xy"]
        x, y = reused.page.evaluate("point => player.cockpit.map.pixel(point)", past)
        near = pixels[int(y) - 2 : int(y) + 3, int(x) - 2 : int(x) + 3].reshape(-1, 3)
        assert (np.abs(near - [255, 210, 63]).sum(axis=1) < 90).any()  # its trail
        x, y = reused.page.evaluate("() => player.cockpit.map.pixel([120, 80])")
        assert np.allclose(pixels[int(y), int(x)], 255, atol=8)  # a place
        reused.page.mouse.click(x, y)
        reused.until_heard({"type": "place", "name": "hill_20"})
        reused.page.keyboard.press("1")

    def test_maps_draw_their_ground_once_for_many_pictures_and_it_goes_along(self, reused):
        """Pictures of the small map while the car goes 127 m, against those whose ground is drawn for each."""
        shown(reused, 3.0)  # the small map is there
        result, apart = reused.ask("""(() => {
          const map = player.cockpit.instruments.inset;
          const { plan } = map;
          const { scenery } = plan;
          plan.scenery = Array.from({ length: 12 }, (_, k) => {
            return { kind: "line", points: [[60 * k - 300, -300], [50 * k - 200, 300]], width: 20 };
          });
          let made = 0;
          const { drawGround } = plan;
          plan.drawGround = (...given) => { made++; drawGround.apply(plan, given); };
          const { width, height } = map._canvas;
          const pictures = (cleared) => Array.from({ length: 31 }, (_, k) => {
            if (cleared || k === 0) map._ground.canvas.width = 1; // what another test has drawn
            map.show({ x: 4 * k, y: 1.4 * k, yaw: 0.3 });
            return map._canvas.getContext("2d").getImageData(0, 0, width, height).data;
          });
          const kept = pictures(false);
          const once = made;
          const fresh = pictures(true);
          delete plan.drawGround;
          plan.scenery = scenery;
          map._ground.canvas.width = 1;
          const share = (a, b) => a.filter((value, i) => Math.abs(value - b[i]) > 100).length / a.length;
          return [[once, made - once], Math.max(...kept.map((picture, k) => share(picture, fresh[k])))];
        })()""")
        assert result[0] <= 3
        assert result[1] == 31
        assert apart < 0.01

    @pytest.mark.slow
    def test_a_report_is_drawn(self, reused):
        shown(reused, 1.0)
        reused.page.keyboard.press("g")
        reused.until_heard({"type": "report"})
        reused.until_heard({"type": "watch devices", "on": True})
        bins = REPORT["cost"]["bins"]
        reused.say(REPORT | {"step": 0.00225})
        reused.page.wait_for_selector('[data-a3="histogram"] rect')
        bars = reused.ask(
            "[...document.querySelectorAll('[data-a3=\"histogram\"] rect')].map(r => r.getAttribute('fill'))"
        )
        assert len(bars) == len(bins)
        assert bars.count(bars[-1]) == 1  # the one beyond the deadline has a colour of its own
        assert "0.06 · 0.2 · 0.9 · 4 ms" in reused.text("report")
        assert "the step ran 1 · other programs ran 0 · the processor stood still 1" in reused.text("report")
        message, tops = reused.ask("""() => {
          const all = name => [...document.querySelectorAll(`[data-a3="histogram"] ${name}`)];
          const number = (part, name) => Number(part.getAttribute(name));
          const texts = all("text").map(t => [t.textContent, number(t, "x"), number(t, "y")]);
          return [texts, all("rect").map(r => number(r, "y"))];
        }""")
        marks = {text: y - 3 for text, x, y in message if x < 40}
        assert {"1", "10", "100", "1k", "steps"} == set(marks)
        for (_, count), top in zip(bins, tops, strict=True):  # both axes by powers of ten
            assert top == pytest.approx(marks["1"] + np.log10(count) / 3 * (marks["1k"] - marks["1"]), abs=0.01)
        assert {"100 µs", "1 ms", "cost of a step; the step of 2.25 ms is dashed"} <= {text for text, *_ in message}
        reused.page.keyboard.press("g")
