"""How fast a page draws, by the processor: ``python -m benchmarks.page_rate [--size W H] [--json FILE]``.

A picture of each scene is drawn again and again in a Chromium without a window, whose WebGL is SwiftShader; each time
one pixel is read, so that the picture is there. On a machine with a graphics card a page is faster by far.
"""

from __future__ import annotations

import json
import statistics
import sys
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from ali3.running import run_command
from benchmarks.shared.command import parser_of, save_rows, watched
from benchmarks.shared.tables import print_table
from mbs import compile
from mbs.scenes import double_four_bar, prototype_car, puma
from mbs.worlds import command as world_command
from viewer import browser
from viewer.bundle import bundle

SIZE = (1280, 720)


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


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = parser_of("page_rate", __doc__)
    parser.add_argument("--pictures", type=int, default=20, metavar="N", help="of each scene; default: 20")
    parser.add_argument(
        "--scenes", nargs="+", choices=SCENES, default=list(SCENES), metavar="NAME", help=f"of {', '.join(SCENES)}"
    )
    parser.add_argument("--size", type=int, nargs=2, default=SIZE, metavar=("W", "H"), help="pixels; default: 1280 720")
    options = parser.parse_args(arguments)
    if options.pictures < 1:
        parser.error("the number of pictures is positive")
    from playwright.sync_api import sync_playwright

    executable = browser.find_chromium()
    script = bundle().read_text(encoding="utf-8")
    rows, renderers = [], set()
    with sync_playwright() as play:
        chromium = play.chromium.launch(executable_path=executable, args=browser.launch_arguments())
        version = chromium.version
        page = chromium.new_page(viewport={"width": options.size[0], "height": options.size[1]})
        page.set_content("<body style='margin:0'><div id='picture' style='width:100vw;height:100vh'></div></body>")
        page.add_script_tag(content=script)
        for name, quality in watched([(name, quality) for name in options.scenes for quality in QUALITIES]):
            found = page.evaluate(MEASURE, [SCENES[name](), quality, options.pictures])
            renderers.add(found["renderer"])
            rows.append(_row(name, quality, found))
        chromium.close()
    times = dict.fromkeys(("ms", "best_ms", "worst_ms", "rate", "first_s"), ".3g")
    print_table(rows, {"scene": "", "quality": "", **times, "calls": "d", "triangles": "d", "bytes": "d"})
    print(
        f"\nms: median of a picture of {options.size[0]} x {options.size[1]}; rate: pictures a second; "
        "first_s: until the first picture; bytes: what a picture of moved things gives to the graphics card"
    )
    print(f"Chromium {version}, {', '.join(sorted(renderers))}; script: {len(script) / 1e3:.0f} kB")
    drawn_by = {"chromium": version, "renderers": sorted(renderers), "size": options.size, "script_bytes": len(script)}
    save_rows(options.json, "page_rate", rows, repeats=options.pictures, warm_up=1, **drawn_by)
    return 0


def _row(name: str, quality: str, found: dict[str, Any]) -> dict[str, Any]:
    ms = statistics.median(found["times"])
    times = {"ms": ms, "best_ms": min(found["times"]), "worst_ms": max(found["times"]), "rate": 1000.0 / ms}
    row = {"scene": name, "quality": quality, **times}
    return row | {"first_s": found["first"] / 1000.0} | {key: found[key] for key in ("triangles", "calls", "bytes")}


if __name__ == "__main__":
    sys.exit(run_command(main))
