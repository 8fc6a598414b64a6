"""All kinds of pages: axe-core finds nothing in light and dark, the bar is one line, the keyboard reaches everything.

axe-core looks for controls without a name, faint words, and parts that no reader finds. It is a tool of developers:
`npm --prefix viewer/page ci --ignore-scripts` installs it; without it its tests are skipped.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fmu_src.build.build import build_fmu
from fmu_src.build.scene_registry import load_scene
from hosts.view.command import main as view
from tests.viewer.hand_scenes import crank
from tests.viewer.simulator_program import Program
from viewer.page_file import write_page
from viewer.recording import Recording

ROOT = Path(__file__).parents[2]
AXE = Path(os.environ.get("ALI3_AXE", ROOT / "viewer" / "page" / "node_modules" / "axe-core" / "axe.min.js"))
FINDINGS = """async () => (await axe.run(document, { resultTypes: ['violations'] })).violations
  .map(({ id, nodes }) => `${id}: ${nodes.length}, such as ${nodes[0].html.slice(0, 120)}`)"""
CONTROLS = "button, select, input, summary, a[href]"
SEEN = f"""() => [...document.querySelectorAll('{CONTROLS}')]
  .filter((part) => part.checkVisibility({{ visibilityProperty: true }}) && !part.disabled)"""
OPEN = """() => {
  for (const part of document.querySelectorAll('details')) part.open = true;
  player.settings?.toggle(true);
}"""
ROWS = """(bar) => {
  const parts = [...document.querySelector(bar).children].map((part) => part.getBoundingClientRect());
  const boxes = parts.filter((box) => box.width);
  const of = (side) => boxes.map((box) => box[side]);
  const rows = Math.max(...of("top")) < Math.min(...of("bottom")) ? 1 : 2;
  return { count: boxes.length, rows, right: Math.max(...of("right")), width: innerWidth };
}"""
INK = """bar => getComputedStyle(document.querySelector(bar + ' button')).color
  .match(/[0-9]+/g).slice(0, 3).map(Number)"""
NAMES = f"""() => ({SEEN})().map((part) =>
  (part.labels?.[0] ?? part).textContent.trim() || part.title || part.ariaLabel)"""
with_axe = pytest.mark.skipif(not AXE.is_file(), reason="axe-core is not installed: npm --prefix viewer/page ci")
KINDS = ("live", "recorded", "plots", "simulator")
BARS = {"live": ".a3-bar", "recorded": ".ali3-bar", "plots": ".ali3-bar", "simulator": ".a3-controls"}
Opened = Callable[..., Any]


@pytest.fixture(scope="module")
def live(tmp_path_factory: pytest.TempPathFactory) -> Path:
    name, system = load_scene(f"{ROOT / 'tests' / 'fmu' / 'scenes.py'}:sprung_reach")
    folder = tmp_path_factory.mktemp("live")
    fmu = build_fmu(system, name, folder, ["wasm32"])
    assert view([str(fmu), "--live", "--paused", "--no-open", "--out", str(folder)]) == 0
    return next(folder.glob("*_live.html"))


def written(folder: Path, kind: str) -> Path:
    t = np.linspace(0.0, 1.0, 11)
    plots = Recording(None, t, {"angle": np.sin(t), "speed": np.cos(t)}, name="plots")
    write_page(folder / f"{kind}.html", plots if kind == "plots" else crank(t), options={"plots": ["angle"]})
    return folder / f"{kind}.html"


@pytest.fixture
def opened(chromium: Any, request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Opened]:
    """Opens a page of a kind, in colours and a width."""

    @contextmanager
    def open_page(
        kind: str, colours: str = "light", width: int = 900, change: Callable[[str], str] = str
    ) -> Iterator[Any]:
        context = chromium.new_context(viewport={"width": width, "height": 500}, color_scheme=colours)
        context.set_default_timeout(60_000)
        page = context.new_page()
        if kind == "simulator":
            places = [{"name": "start", "x": 0.0, "y": 0.0, "yaw": 0.0}]
            world = {"name": "here", "places": places, "bounds": [-9, -9, 9, 9]}
            program = Program(page, crank(np.linspace(0.0, 1.0, 11)), world=world)
            program.open()
            program.send(0.5, 0)
        else:
            file = request.getfixturevalue("live") if kind == "live" else written(tmp_path, kind)
            text = change(file.read_text(encoding="utf-8"))
            (tmp_path / "shown.html").write_text(text, encoding="utf-8")
            page.goto((tmp_path / "shown.html").as_uri())
            page.evaluate("async () => { await player.ready; }")
        yield page
        context.close()

    return open_page


def findings(page: Any) -> list[str]:
    page.evaluate(OPEN)
    page.evaluate(AXE.read_text(encoding="utf-8"))
    found: list[str] = page.evaluate(FINDINGS)
    return found


@with_axe
@pytest.mark.slow
@pytest.mark.parametrize("colours", ["light", "dark"])
@pytest.mark.parametrize("kind", KINDS)
def test_axe_finds_nothing(opened: Opened, kind: str, colours: str) -> None:
    with opened(kind, colours) as page:
        assert findings(page) == []


@with_axe
@pytest.mark.slow
def test_axe_would_find_a_control_without_a_name(opened: Opened) -> None:
    with opened("recorded", change=lambda text: text.replace('<main id="view">', "<input><main id=view>")) as page:
        assert any(words.startswith("label: 1") for words in findings(page))


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_pages_are_dark_where_everything_is(opened: Opened, kind: str) -> None:
    """Words and what is behind them change their places between light and dark."""
    inks = []
    for colours in ("light", "dark"):
        with opened(kind, colours) as page:
            inks.append(sum(page.evaluate(INK, BARS[kind])))
    if kind == "simulator":
        assert max(inks) == min(inks), "its words stand on the picture, on dark glass"
    else:
        assert inks[0] < 300 < 500 < inks[1]


@pytest.mark.slow
@pytest.mark.parametrize("width", [800, 1000])
@pytest.mark.parametrize("kind", KINDS)
def test_the_bar_is_one_line(opened: Opened, kind: str, width: int) -> None:
    with opened(kind, width=width) as page:
        found = page.evaluate(ROWS, BARS[kind])
        assert found["count"] > 3
        assert found["rows"] == 1
        assert found["right"] <= found["width"]


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_the_tabulator_reaches_every_control_and_all_have_names(opened: Opened, kind: str) -> None:
    with opened(kind) as page:
        page.evaluate(OPEN)
        names = page.evaluate(NAMES)
        assert len(names) > 5
        assert all(names), names
        page.evaluate(f"() => {{ window.left = new Set(({SEEN})()); }}")
        for _ in range(3 * len(names) + 20):
            page.keyboard.press("Tab")
            if page.evaluate("() => (left.delete(document.activeElement), left.size)") == 0:
                break
        assert page.evaluate("() => [...left].map((part) => part.outerHTML.slice(0, 100))") == []
