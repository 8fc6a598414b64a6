"""All kinds of pages: axe-core finds nothing in light and dark, the bar is one line, the keyboard reaches everything.

axe-core looks for controls without a name, faint words, and parts that no reader finds. It is a tool of developers:
`npm --prefix viewer/page ci --ignore-scripts` installs it; without it its tests are skipped.
"""

import json
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ali3.scene.recording import Recording
from hosts.view.command import main as view
from tests.in_browser import axe_findings, wait_until, with_axe
from tests.viewer.bars import check_bar
from tests.viewer.hand_scenes import crank
from tests.viewer.simulator_program import REPORT, Program
from viewer.bundle import HERE
from viewer.page_file import write_page

CONTROLS = "button, select, input, summary, a[href], [role=application]"
SEEN = f"""() => [...document.querySelectorAll('{CONTROLS}')]
  .filter((part) => part.checkVisibility({{ visibilityProperty: true }}) && !part.disabled)"""
OPEN = """() => {
  for (const part of document.querySelectorAll('details')) part.open = true;
  const shell = player.cockpit ?? player;
  shell.settings.toggle(true);
  if (shell === player.cockpit) shell.side(true);
}"""
INK = """bar => getComputedStyle(document.querySelector(bar + ' button')).color
  .match(/[0-9]+/g).slice(0, 3).reduce((sum, part) => sum + Number(part), 0)"""
BOXES = """() => ['.a3-bar', '.a3-left', '.a3-cluster', '.a3-inset'].map((part) => document.querySelector(part))
  .filter((part) => part?.checkVisibility()).map((part) => part.getBoundingClientRect().toJSON())"""
ROLES = ("button", "slider", "combobox", "checkbox", "searchbox", "spinbutton", "image", "DisclosureTriangle", "link")
ADDED = """() => {
  const { notices } = player.cockpit ?? player;
  const late = (words) => notices.flag('late', words, { bad: true });
  late('late by 1.5 s');
  const box = document.querySelector('[data-a3="flag late"]');
  const seen = new MutationObserver(() => {});
  seen.observe(box, { childList: true });
  late('late by 2 s');
  const numbers = seen.takeRecords().length;
  late('not late any more');
  const words = seen.takeRecords().length;
  notices.lower(['late']);
  const logs = ['notes', 'events'].map((name) => document.querySelector(`[data-a3="${name}"]`));
  for (const line of ['one', 'two']) notices.tell(line);
  const lines = [...logs[1].children].slice(-2).map((line) => line.textContent);
  return { numbers, words, role: box.role, logs: logs.map(({ role }) => role), lines };
}"""
LISTED = """() => [...document.querySelectorAll('.a3-help > div > div')]
  .map((line) => [...line.children].map((part) => part.textContent))"""
KINDS = ("live", "recorded", "plots", "simulator")
BAR = ".a3-bar"


@pytest.fixture(scope="module")
def live(live_reach: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("live")
    assert view([str(live_reach), "--live", "--paused", "--no-open", "--out", str(folder)]) == 0
    return next(folder.glob("*_live.html"))


def written(folder: Path, kind: str) -> Path:
    t = np.linspace(0.0, 1.0, 11)
    plots = Recording(None, t, {"angle": np.sin(t), "speed": np.cos(t)}, name="plots")
    write_page(folder / f"{kind}.html", plots if kind == "plots" else crank(t), options={"plots": ["angle"]})
    return folder / f"{kind}.html"


@contextmanager
def dark_page(chromium: Any) -> Iterator[Any]:
    """An empty page in a browser whose user likes it dark."""
    context = chromium.new_context(viewport={"width": 900, "height": 500}, color_scheme="dark")
    context.set_default_timeout(60_000)
    yield context.new_page()
    context.close()


def open_file(page: Any, file: Path) -> None:
    page.goto(file.as_uri())
    page.evaluate("async () => { await player.ready; }")


def open_simulator(page: Any) -> None:
    places = [{"name": "start", "x": 0.0, "y": 0.0, "yaw": 0.0}]
    world = {"name": "here", "places": places, "bounds": [-9, -9, 9, 9]}
    program = Program(page, crank(np.linspace(0.0, 1.0, 11)), world=world)
    program.open()
    program.send(0.5, 0)
    program.say(REPORT)


def use_colours(page: Any, colours: str) -> None:
    """Until its words are as dark as they are to be."""
    page.emulate_media(color_scheme=colours)
    bright = "> 500" if colours == "dark" else "< 300"
    wait_until(page, f"(bar) => ({INK})(bar) {bright}", BAR)


@pytest.fixture(scope="module", params=KINDS)
def kind(request: pytest.FixtureRequest) -> str:
    """One after the other: a page that is open slows all others down."""
    return str(request.param)


@pytest.fixture(scope="module")
def shown(kind: str, chromium: Any, request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Any:
    """A page of the kind for all tests, each of which says in which colours and width it wants it."""
    with dark_page(chromium) as page:
        if kind == "simulator":
            open_simulator(page)
        elif kind == "live":
            open_file(page, request.getfixturevalue("live"))
        else:
            open_file(page, written(tmp_path_factory.mktemp("shown"), kind))
        yield page


def findings(page: Any) -> list[str]:
    page.evaluate(OPEN)
    return axe_findings(page)


@pytest.mark.slow
def test_pages_are_dark_where_everything_is(shown: Any) -> None:
    """Words and what is behind them change their places between light and dark, also while the page is open."""
    for colours in ("dark", "light"):  # it was opened in the dark
        use_colours(shown, colours)


@pytest.mark.slow
def test_the_bar_is_one_line(shown: Any) -> None:
    for width in (800, 901, 1000, 1061, 1280):
        check_bar(shown, BAR, width)


@pytest.mark.slow
def test_figures_in_a_low_page_leave_the_middle_of_the_picture_free(live: Path, chromium: Any) -> None:
    with dark_page(chromium) as page:
        page.set_viewport_size({"width": 800, "height": 450})
        open_file(page, live)
        message = "This machine does not keep up: 0.82 s of the run a second, 1 asked for."
        page.evaluate("words => { player.notices.flag('problem', words, { bad: true }); player.tell(words); }", message)
        figures, picture, notices = (
            page.evaluate("part => document.querySelector(part).getBoundingClientRect().toJSON()", part)
            for part in (".a3-timing", "canvas", ".a3-notices")
        )
    assert figures["right"] <= picture["left"] + 0.4 * picture["width"]
    assert figures["height"] <= 0.5 * picture["height"]
    assert notices["bottom"] < figures["top"]


@pytest.mark.slow
def test_no_instrument_of_the_simulator_lies_over_another_in_small_windows(chromium: Any) -> None:
    """The smallest is 800 x 450 pixels at a zoom of 200 %."""
    with dark_page(chromium) as page:
        open_simulator(page)
        over = []
        for width, height in ((400, 225), (640, 360), (800, 450)):
            page.set_viewport_size({"width": width, "height": height})
            boxes = page.evaluate(BOXES)
            assert len(boxes) >= 2, "the bar and the cluster"
            over += [
                (width, a, b)
                for a, b in combinations(boxes, 2)
                if all(a[low] < b[high] and b[low] < a[high] for low, high in (("left", "right"), ("top", "bottom")))
            ]
    assert over == []


@pytest.mark.slow
def test_no_instrument_lies_over_the_world_on_the_map(chromium: Any) -> None:
    """Nor is the world small: it is as wide or as high as what is left of the window."""
    with dark_page(chromium) as page:
        open_simulator(page)
        page.evaluate("player.camera('map')")
        page.evaluate("player.cockpit.instruments.tyres.element.style.display = ''")  # as of a car
        for width, height, half in ((640, 360, 9), (800, 450, 9), (960, 540, 15), (1280, 720, 9)):
            page.set_viewport_size({"width": width, "height": height})
            page.evaluate("half => { player.cockpit.plan.bounds = [-half, -9, half, 9]; }", half)
            wait_until(page, f"player.cockpit.map._canvas.width === {width}")
            (left, top), (right, bottom) = page.evaluate(
                "half => [[-half, 9], [half, -9]].map((point) => player.cockpit.map.pixel(point))", half
            )
            assert min(left, top, width - right, height - bottom) >= 0
            assert bottom - top > 0.5 * height
            for box in page.evaluate(BOXES):
                beside = box["right"] <= left or box["left"] >= right or box["bottom"] <= top or box["top"] >= bottom
                assert beside, (width, box)


def test_words_in_the_bars_of_the_instruments_differ_from_what_fills_them(chromium: Any) -> None:
    """By a contrast of 4.5, as words elsewhere; programs that look for faint words do not see what lies over a word."""
    with dark_page(chromium) as page:
        open_simulator(page)
        colours = page.evaluate(
            """() => [...document.querySelectorAll('.a3-gauge')]
              .map((bar) => ['i', 'span'].map((part) => {
                const style = getComputedStyle(bar.querySelector(part));
                return (part === 'i' ? style.backgroundColor : style.color).match(/[0-9]+/g).map(Number);
              }))"""
        )
    assert len(colours) >= 5, "steering, pedals and the cost of a step"
    part = np.asarray(colours) / 255.0
    linear = np.where(part <= 0.04045, part / 12.92, ((part + 0.055) / 1.055) ** 2.4)  # IEC 61966-2-1
    luminance = np.sort(linear @ [0.2126, 0.7152, 0.0722], axis=1)
    contrast = (luminance[:, 1] + 0.05) / (luminance[:, 0] + 0.05)  # WCAG 2.2
    assert contrast.min() >= 4.5


@with_axe
@pytest.mark.slow
@pytest.mark.parametrize("colours", ["light", "dark"])
def test_axe_finds_nothing(shown: Any, colours: str) -> None:
    use_colours(shown, colours)
    if colours == "dark":  # scroll bars and fields too
        assert "dark" in shown.evaluate("bar => getComputedStyle(document.querySelector(bar)).colorScheme", BAR)
    assert findings(shown) == []
    shown.evaluate("(player.cockpit ?? player).help?.toggle(true)")
    assert findings(shown) == [], "with the list of keys over it"
    shown.evaluate("(player.cockpit ?? player).help?.toggle(false)")


@pytest.mark.slow
def test_the_tab_key_reaches_every_control(shown: Any) -> None:
    shown.evaluate(OPEN)
    count = shown.evaluate(f"() => {{ window.left = new Set(({SEEN})()); return left.size; }}")
    assert count > 5
    for _ in range(3 * count + 20):
        shown.keyboard.press("Tab")
        if shown.evaluate("() => (left.delete(document.activeElement), left.size)") == 0:
            break
    assert shown.evaluate("() => [...left].map((part) => part.outerHTML.slice(0, 100))") == []


def focused(page: Any) -> str:
    return str(page.evaluate("document.activeElement.dataset.a3 ?? document.activeElement.tagName"))


@pytest.mark.slow
@pytest.mark.parametrize("by", ["Enter", " ", "key"])
def test_what_the_keyboard_opens_it_closes_and_the_focus_comes_back(shown: Any, by: str) -> None:
    press, shell = shown.keyboard.press, "(player.cockpit ?? player)"
    shown.evaluate(f"() => {{ {shell}.settings.toggle(false); {shell}.side(false); }}")

    def opened(name: str, key: str, part: str) -> Any:
        press("Tab")  # the keyboard moves the focus
        shown.locator(f'[data-a3="{name}"]').focus()
        press(key if by == "key" else by)
        assert shown.locator(part).is_visible()
        return shown.locator(part)

    settings = opened("settings", "o", ".a3-panel")
    settings.locator("[data-a3=theme]").focus()  # a list, which keeps letters to itself
    press("Escape")
    assert not settings.is_visible()
    assert focused(shown) == "settings"
    keys = opened("help", "h", "[data-a3='help list']")
    press("g")
    assert not shown.locator(".a3-side").is_visible(), "a key of the page behind the list"
    for _ in range(3):
        assert focused(shown) in ("help list", "BODY"), "behind the list of keys"
        press("Tab")
    press("Escape")
    assert not keys.is_visible()
    assert focused(shown) == "help"
    side = opened("panels", "g", ".a3-side")
    side.locator(".a3-find button").focus()
    press("g")
    assert not side.is_visible()
    assert focused(shown) == "panels"


@pytest.mark.slow
def test_a_picture_and_a_diagram_have_keys_while_the_focus_is_on_them(shown: Any, kind: str) -> None:
    shell = "(player.cockpit ?? player)"
    press = shown.keyboard.press

    def changed_by(key: str, part: str, expression: str) -> tuple[Any, Any]:
        press("Tab")  # the keyboard moves the focus
        shown.locator(part).first.focus()
        before = shown.evaluate(expression)
        press(key)
        return before, shown.evaluate(expression)

    if kind != "plots":
        picture, camera = ".a3-views canvas[aria-label^=drawing]", f"{shell}.view.cameras.current.position.toArray()"
        shown.evaluate(f"{shell}.camera('orbit')")
        for key in ("Shift+ArrowLeft", "+") if shown.evaluate(f"{shell}.view.scene.planar") else ("ArrowLeft", "+"):
            expression = f"[{camera}, {shell}.view.cameras.free.zoom]"
            before, after = changed_by(key, picture, expression)
            assert before != after, key
        spoken = "document.querySelector('.a3-notes [role=status]').textContent"
        none, body = changed_by("Enter", picture, spoken)
        assert none == ""
        has_bodies = shown.evaluate(f"{shell}.view.parts.moving.length > 0")  # that of the live page has no pose
        assert (body != "") is has_bodies
        shown.evaluate(f"{shell}.view.pick(-1, -1)")
    shown.evaluate(f"{shell}.side(true)")
    shown.evaluate(f"{shell}.plots.choose({shell}.plots.names.slice(-1))")
    if kind in ("recorded", "plots"):
        span = f"(({{ min, max }}) => max - min)({shell}.plots.charts[0].plot.scales.x)"
        for key, shorter in (("+", True), ("-", False)):
            before, after = changed_by(key, ".u-over", span)
            assert (after < before) is shorter
    shown.evaluate("document.activeElement.blur()")


@pytest.mark.slow
def test_arrows_open_a_list_and_choose_nothing_that_they_pass(shown: Any) -> None:
    shell = "(player.cockpit ?? player)"
    shown.evaluate(f"() => {{ {shell}.theme('auto'); {shell}.settings.toggle(true); }}")
    shown.locator("[data-a3=theme]").focus()
    names = []
    for key in ("ArrowDown", "ArrowDown", "ArrowDown", "Enter"):
        shown.keyboard.press(key)
        names.append(shown.evaluate(f"{shell}.themeName"))
    assert names == ["auto", "auto", "auto", "dark"]
    shown.evaluate(f"() => {{ {shell}.theme('auto'); {shell}.settings.toggle(false); document.activeElement.blur(); }}")


@pytest.mark.slow
def test_what_the_mouse_opened_leaves_the_keys_to_the_page(shown: Any) -> None:
    for name, part in (("settings", ".a3-panel"), ("help", "[data-a3='help list']")):
        shown.locator(f'[data-a3="{name}"]').click()
        assert shown.locator(part).is_visible()
        for box in shown.locator(f"{part} input[type=checkbox]").all():
            box.click()
        shown.keyboard.press("Escape")
        assert not shown.locator(part).is_visible()
        # A browser takes the focus from a hidden part when it draws the next frame.
        shown.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
        assert focused(shown) == "BODY"


def test_the_list_of_keys_has_rows_of_the_table_for_this_kind_of_page(shown: Any, kind: str) -> None:
    rows = json.loads((HERE / "keys.json").read_text(encoding="utf-8"))
    kinds = {"": KINDS, "driven": ("live", "simulator"), "recorded": ("recorded", "plots"), "simulator": ("simulator",)}
    expected = [[row["shown"], row["words"]] for row in rows if kind in kinds[row.get("where", "")]]
    listed = shown.evaluate(LISTED)
    assert listed == [line for line in expected if line in listed]
    assert {"P", "Home", "O", "Esc", "H or ?"} <= {key for key, _ in listed}


def test_the_tree_of_the_browser_names_every_control(shown: Any) -> None:
    shown.evaluate(OPEN)
    session = shown.context.new_cdp_session(shown)
    session.send("Accessibility.enable")
    nodes = [node for node in session.send("Accessibility.getFullAXTree")["nodes"] if not node["ignored"]]
    session.detach()
    results = [(node["role"]["value"], node.get("name", {}).get("value", "").strip()) for node in nodes]
    controls = [(role, name) for role, name in results if role in ROLES]
    assert {role for role, _ in controls} >= {"button", "slider", "combobox"}
    assert [role for role, name in controls if not name] == []
    sliders = shown.evaluate("[...document.querySelectorAll('input[type=range]')].map((one) => one.ariaValueText)")
    assert all(sliders), "positions of sliders are no values"


def test_what_happens_is_read_aloud_once_and_the_numbers_of_a_state_are_not(shown: Any) -> None:
    """Chromium tells a reader what is added to a live region; a log is read line by line."""
    assert shown.evaluate(ADDED) == {
        "numbers": 0,
        "words": 1,
        "role": "alert",
        "logs": ["log", "log"],
        "lines": ["one", "two"],
    }
