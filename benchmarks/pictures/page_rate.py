"""How fast a page draws, by the processor; on a machine with a graphics card a page is faster by far."""

from __future__ import annotations

import json
import statistics
import tempfile
from argparse import Namespace
from collections.abc import Callable
from pathlib import Path
from typing import Any

from benchmarks.shared.command import watched
from mbs import compile
from mbs.scenes import double_four_bar, prototype_car, puma
from mbs.worlds import command as world_command
from viewer import browser
from viewer.bundle import bundle

SIZE = (1280, 720)
COLUMNS = {"scene": "", "quality": ""} | dict.fromkeys(("ms", "best_ms", "worst_ms", "rate", "first_s"), ".3g")
COLUMNS |= dict.fromkeys(("calls", "triangles", "bytes"), "d")
WORDS = """ms: median of a picture; rate: pictures a second; first_s: until the first picture; bytes: what a picture of
moved things gives to the graphics card"""


def in_world(name: str) -> dict[str, Any]:
    """The prototype car in a world, as drawn."""
    with tempfile.TemporaryDirectory() as folder:
        if world_command.main(["--world", name, "--out", folder]) != 0:
            raise RuntimeError(f"the world {name} cannot be made")
        world = json.loads(Path(folder, f"{name}.json").read_text(encoding="utf-8"))
    return compile(prototype_car.build()).scene | {"roads": world["roads"], "scenery": world["scenery"]}


SCENES: dict[str, Callable[[], dict[str, Any]]] = {
    "prototype_car": lambda: compile(prototype_car.build()).scene,
    "proving_ground": lambda: in_world("proving_ground"),
    "puma": lambda: compile(puma.build()).scene,
    "double_four_bar": lambda: compile(double_four_bar.build()).scene,
}
QUALITIES = ("draft", "low", "high")
MEASURE = """([scene, quality, count]) => {
  const began = performance.now();
  const view = new ALi3Viewer.SceneView(document.getElementById('picture'), scene, { quality });
  if (view.problem) throw new Error(view.problem);
  const gl = view.renderer.getContext();
  const draw = () => {
    view.update(null);
    view.render();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
  };
  draw();
  const first = performance.now() - began;
  const times = [];
  for (let i = 0; i < count; i++) {
    const start = performance.now();
    draw();
    times.push(performance.now() - start);
  }
  let bytes = 0;
  for (const method in gl) {
    const uniform = /^uniform[1-4M]/.test(method);
    if (!uniform && !/^(buffer|tex)(Sub)?(Data|Image2D)$/.test(method)) continue;
    const call = gl[method];
    gl[method] = (...values) => {
      for (const x of values.slice(1)) bytes += x?.byteLength ?? 4 * (x?.length ?? (uniform && typeof x === 'number'));
      return call.apply(gl, values);
    };
  }
  view.origin = [view.origin[0] + 0.1, view.origin[1] + 0.1, view.origin[2]];
  view.render();
  const { render } = view.renderer.info;
  const info = gl.getExtension('WEBGL_debug_renderer_info');
  const found = { first, times, triangles: render.triangles, calls: render.calls, bytes };
  found.renderer = gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER);
  view.dispose();
  return found;
}"""


def measure(options: Namespace) -> list[dict[str, Any]]:
    """A picture of each scene is drawn again and again in each quality."""
    from playwright.sync_api import sync_playwright

    script, width, height = bundle().read_text(encoding="utf-8"), *options.size
    rows, renderers = [], set()
    with sync_playwright() as play:
        chromium = play.chromium.launch(executable_path=browser.find_chromium(), args=browser.launch_arguments())
        version = chromium.version
        page = chromium.new_page(viewport={"width": width, "height": height})
        page.set_content("<body style='margin:0'><div id='picture' style='width:100vw;height:100vh'></div></body>")
        page.add_script_tag(content=script)
        for name, quality in watched([(name, quality) for name in options.only for quality in QUALITIES]):
            found = page.evaluate(MEASURE, [SCENES[name](), quality, options.pictures])
            renderers.add(found["renderer"])
            rows.append(_row(name, quality, found))
        chromium.close()
    print(f"Chromium {version}, {', '.join(sorted(renderers))}; script: {len(script) / 1e3:.0f} kB")
    return rows


def _row(name: str, quality: str, found: dict[str, Any]) -> dict[str, Any]:
    ms = statistics.median(found["times"])
    times = {"ms": ms, "best_ms": min(found["times"]), "worst_ms": max(found["times"]), "rate": 1000.0 / ms}
    row = {"scene": name, "quality": quality, **times}
    return row | {"first_s": found["first"] / 1000.0} | {key: found[key] for key in ("triangles", "calls", "bytes")}
