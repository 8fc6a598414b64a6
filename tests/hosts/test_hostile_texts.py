"""A foreign FMU with markup in every text: pages show it literally, and nothing of it runs."""

import json
import re
from collections.abc import Callable
from html import escape
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ali3 import html
from ali3.scene.recording import Recording
from ali3.scene.scene import scene_errors
from fmu_src.description.documentation import documentation
from fmu_src.variables.variables import Variable
from hosts.catalogue.report import write_report
from hosts.compare.command import main as compare
from hosts.view.command import main
from tests.hosts.catalogue import synthetic_records
from tests.hosts.changed_fmu import DESCRIPTION, changed_fmu
from tests.in_browser import wait_until
from tests.viewer.hand_scenes import floats
from tests.viewer.simulator_program import Program
from viewer.page_file import write_page

pytestmark = pytest.mark.drawn

MARK = "<img src=x onerror=globalThis.ran=1><script>globalThis.ran=2</script>"
MARKUP = f"</title></style></script>-->{MARK}<svg onload=globalThis.ran=3>'\"&lt;"
NAME = "&lt;b onload='globalThis.ran=4'&gt; \"name\""  # a scene has no names with < and >
SIGNAL = "bob.y <b onclick=globalThis.ran=8>'\"&lt;"
TEXTS = ("description", "author", "copyright", "version")
ANCHORS = [["ground", [0, 0, 0]], ["ground", [0, 1, 0]]]


def drawing() -> dict[str, Any]:
    """A scene with a text in every place that takes one."""
    stress = {"fibres": 1, "rows": floats(np.full((1, 2, 1, 1), 1e6)), "limit": 1e6, "limit_name": NAME}
    tube = {"frame": "ground", "nodes": [[0, 0, 0], [0, 1, 0]], "beams": [[0, 1]], "radii": [0.05], "name": NAME}
    tube |= {"names": [NAME, NAME], "amplitudes": ["bob.x"], "modes": floats(np.ones((2, 3, 1))), "note": MARKUP}
    return {
        **{"format": "ALi3 scene", "version": 1, "name": NAME, "description": MARKUP, "extent": 2.0, "frames": {}},
        "shapes": [{"kind": "sphere", "frame": "ground", "radius": 0.1, "name": NAME, "body": NAME}],
        "flexible": [tube | {"stress": stress}],
        "arrows": [{"name": NAME, "unit": "N.m", "value": "bob.x", "between": ANCHORS}],
        "missing": [{"name": MARKUP, "why": MARKUP}],
    }


@pytest.fixture(scope="module")
def foreign(scene_fmu: Callable[..., Path], tmp_path_factory: pytest.TempPathFactory) -> Path:
    built = scene_fmu(f"{Path(__file__).parent / 'scenes.py'}:tuned", wasm=True)
    file = tmp_path_factory.mktemp("foreign") / "Foreign.fmu"

    def hostile(content: bytes) -> bytes:
        text = content.decode()
        for attribute in TEXTS:
            text = re.sub(rf'(<[^?>]* {attribute}=)"[^"]*"', rf'\1"{escape(MARKUP)}"', text)
        text = text.replace('name="bob.y"', f'name="{escape(SIGNAL)}"')
        text = re.sub(r'([uU]nit|<Unit name)="m"', rf'\1="{escape(MARKUP)}"', text)
        assert text.count(escape(MARKUP)) > 12
        return text.encode()

    changes = {DESCRIPTION: hostile, "resources/geometry.json": json.dumps(drawing()).encode()}
    return changed_fmu(built, file, changes)


def opened(chromium: Any, file: Path) -> Any:
    page = chromium.new_page(viewport={"width": 900, "height": 600})
    page.goto(file.as_uri())
    return page


def check(shown: Any, *texts: str) -> None:
    """Texts stand in the page as they are; nothing has run, nor does it when markup is put into the page."""
    shown.wait_for_timeout(100)
    assert shown.evaluate("globalThis.ran") is None
    assert shown.evaluate("document.querySelectorAll('img[src=x], svg[onload], b[onload]').length") == 0
    seen = shown.evaluate("document.title + document.body.innerText")
    for text in texts:
        assert " ".join(text.split()) in " ".join(seen.split()), text
    shown.evaluate(
        "mark => document.body.insertAdjacentHTML('beforeend', mark)", f"{MARK}<b onclick=globalThis.ran=5>b"
    )
    shown.evaluate(
        """() => {
          document.querySelector('b[onclick]').click();
          const script = document.createElement('script');
          script.textContent = 'globalThis.ran = 6';
          document.body.append(script);
          setTimeout('globalThis.ran = 7', 0);
        }""",
        MARK,
    )
    shown.wait_for_timeout(200)
    assert shown.evaluate("globalThis.ran") is None
    shown.close()


@pytest.mark.slow
def test_view_with_arrows(foreign, tmp_path, chromium):
    file = tmp_path / "Foreign.html"
    arguments = ["--arrows", "--stress", "--plot", SIGNAL, "--stop-time", "0.1", "--out", str(tmp_path), "--no-open"]
    assert main([str(foreign), *arguments]) == 0
    shown = opened(chromium, file)
    assert shown.evaluate("async () => { await player.ready; return player.problem; }") == ""
    assert shown.locator("[data-legend=stress]").inner_text().splitlines()[-1] == f"{NAME}: 1 MPa"
    assert shown.locator("[data-legend=arrows]").inner_text().endswith("N·m")
    check(shown, SIGNAL, f"is not drawn: {MARKUP}")


def with_text(key: str, text: str) -> dict[str, Any]:
    """The drawing with another text in a place."""
    scene = drawing()
    place: Any = scene
    *parents, last = (int(part) if part.isdigit() else part for part in re.findall(r"\w+", key))
    for part in parents:
        place = place[part]
    place[last] = text
    return scene


KEYS = (
    *("name", "arrows[0].name", "arrows[0].unit", "shapes[0].name", "shapes[0].body", "flexible[0].name"),
    *("flexible[0].names[1]", "flexible[0].stress.unit", "flexible[0].stress.limit_name"),
)


@pytest.mark.parametrize("key", ["arrows[0].unit", "flexible[0].stress.limit_name"])
def test_units_and_names_that_are_markup_are_refused_by_the_reader_and_by_the_page(key, tmp_path, chromium):
    scene = with_text(key, MARKUP)
    assert all([e.partition(" is ")[0] for e in scene_errors(with_text(k, MARKUP))] == [k] for k in KEYS)
    recording = Recording(drawing(), np.array([0.0, 1.0]), {"bob.x": np.array([0.0, 1.0])})
    assert recording.scene is not None
    recording.scene.update(scene)  # past the reader
    shown = opened(chromium, write_page(tmp_path / "p.html", recording, options={"arrows": True}).path)
    problem = shown.evaluate("async () => { await player.ready; return player.problem; }")
    assert re.fullmatch(
        r"The scene has the (unit|name) \".*; a \1 is without control characters, < and >.*\.", problem, re.DOTALL
    )
    check(shown, problem)


@pytest.mark.slow
def test_the_page_that_runs_it(foreign, tmp_path, chromium):
    arguments = ["--title", MARKUP, "--plot", SIGNAL, "--out", str(tmp_path)]
    assert main([str(foreign), "--live", "--no-open", *arguments]) == 0
    shown = opened(chromium, tmp_path / "Foreign_live.html")
    shown.evaluate("async () => { await player.ready; }")
    wait_until(shown, "player.time > 0.1")
    shown.evaluate("document.querySelectorAll('details').forEach((part) => (part.open = true))")
    assert shown.evaluate("document.querySelectorAll('[title]').length") > 0
    check(shown, MARKUP, SIGNAL)


@pytest.mark.slow
def test_the_simulator(chromium):
    columns = {"speed": np.zeros(2), "bob.x": np.ones(2), SIGNAL: np.ones(2)}
    recording = Recording(drawing(), np.array([0.0, 1.0]), columns, {"speed": MARKUP, SIGNAL: MARKUP}, MARKUP)
    place = {"name": MARKUP, "x": 0.0, "y": 0.0, "yaw": 0.0}
    world = {"name": MARKUP, "places": [place], "bounds": [-9, -9, 9, 9]}
    program = Program(chromium.new_page(), recording, world=world, recording_name=MARKUP)
    for variable in program.hello["description"]["variables"]:
        variable["description"] = MARKUP
    program.hello["description"] |= {"modelName": MARKUP, "description": MARKUP}
    program.hello["recording"] = MARKUP
    program.open()
    program.say({"type": "event", "kind": "log", "time": 0.0, "text": MARKUP})
    program.say({"type": "event", "kind": MARKUP, "time": 0.0, "text": MARKUP})
    program.say({"type": "refused", "text": MARKUP})
    program.send(0.5)
    wait_until(program.page, "player.frames.newest")
    check(program.page, MARKUP)


@pytest.mark.slow
def test_reports(foreign, tmp_path, chromium, monkeypatch):
    monkeypatch.setattr(synthetic_records, "EVIL", MARKUP)
    write_report(tmp_path / "report.html", *synthetic_records.synthetic(tmp_path / "none.fmu", tests=2, points=50))
    shown = opened(chromium, tmp_path / "report.html")
    assert shown.evaluate("getComputedStyle(document.querySelector('table')).borderCollapse") == "collapse"
    check(shown, MARKUP)
    t = np.linspace(0.0, 2.0, 201)
    heading = f'time,pull,"{SIGNAL.replace(chr(34), 2 * chr(34))}"'
    rows = "\n".join(f"{a!r},0.0,{b!r}" for a, b in zip(t.tolist(), (-1.0 - 0.1 * np.sin(7 * t)).tolist(), strict=True))
    (tmp_path / "log.csv").write_text(f"{heading}\n{rows}\n")
    assert compare([str(foreign), str(tmp_path / "log.csv"), "--out", str(tmp_path)]) == 0
    check(opened(chromium, tmp_path / "log.html"), SIGNAL)


def test_the_documentation_in_an_fmu(tmp_path, chromium):
    variable = Variable(MARKUP, "output", "continuous", MARKUP, MARKUP, "sensor", 0)
    text = documentation(MARKUP, MARKUP, MARKUP, 0.01, [variable], [MARKUP])
    (tmp_path / "index.html").write_text(text, encoding="utf-8")
    check(opened(chromium, tmp_path / "index.html"), MARKUP)


def test_a_script_that_is_not_whole_is_refused():
    for text in ("</script>", "</SCRIPT >", "<!--", "a\rb"):
        with pytest.raises(ValueError, match="holds </script"):
            html.page("title", "", scripts=[text])
