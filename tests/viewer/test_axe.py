"""Pages by axe-core, which looks for controls without a name, faint words, and parts that no reader finds.

It is a tool of developers: `npm --prefix viewer/page ci --ignore-scripts` installs it; without it the test is skipped.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fmu_src.build.build import build_fmu
from fmu_src.build.scene_registry import load_scene
from hosts.view.command import main as view
from tests.viewer.hand_scenes import crank
from viewer.page_file import write_page

ROOT = Path(__file__).parents[2]
AXE = Path(os.environ.get("ALI3_AXE", ROOT / "viewer" / "page" / "node_modules" / "axe-core" / "axe.min.js"))
FINDINGS = """async () => (await axe.run(document, { resultTypes: ['violations'] })).violations
  .map(({ id, nodes }) => `${id}: ${nodes.length}, such as ${nodes[0].html.slice(0, 120)}`)"""

pytestmark = pytest.mark.skipif(not AXE.is_file(), reason="axe-core is not installed: npm --prefix viewer/page ci")


@pytest.fixture(scope="module")
def live(tmp_path_factory: pytest.TempPathFactory) -> Path:
    name, system = load_scene(f"{ROOT / 'tests' / 'fmu' / 'scenes.py'}:sprung_reach")
    folder = tmp_path_factory.mktemp("live")
    fmu = build_fmu(system, name, folder, ["wasm32"])
    assert view([str(fmu), "--live", "--paused", "--no-open", "--out", str(folder)]) == 0
    return next(folder.glob("*_live.html"))


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("recorded") / "page.html"
    write_page(file, crank(np.linspace(0.0, 1.0, 11)), options={"plots": ["angle"]})
    return file


def findings(chromium: Any, file: Path, colours: str) -> list[str]:
    context = chromium.new_context(viewport={"width": 900, "height": 500}, color_scheme=colours)
    page = context.new_page()
    page.goto(file.as_uri())
    page.evaluate("async () => { await player.ready; }")
    page.evaluate("for (const part of document.querySelectorAll('details')) part.open = true")
    page.evaluate("window.player.settings?.toggle(true)")
    page.evaluate(AXE.read_text(encoding="utf-8"))
    found: list[str] = page.evaluate(FINDINGS)
    context.close()
    return found


@pytest.mark.parametrize("kind", ["live", "recorded"])
def test_axe_finds_nothing_in_light_and_dark(chromium: Any, kind: str, request: pytest.FixtureRequest) -> None:
    file = request.getfixturevalue(kind)
    assert [findings(chromium, file, colours) for colours in ("light", "dark")] == [[], []]


def test_axe_would_find_a_control_without_a_name(chromium: Any, recorded: Path, tmp_path: Path) -> None:
    file = tmp_path / "wrong.html"
    text = recorded.read_text(encoding="utf-8")
    file.write_text(text.replace('<main id="view">', "<input><main id=view>"), encoding="utf-8")
    assert any(words.startswith("label: 1") for words in findings(chromium, file, "light"))
