"""Pictures of a car while it is driven: ``python -m benchmarks.driven_pages [--seconds S] [--json FILE]``.

The prototype car on the proving ground is driven by keys for a minute, in the simulator and in the page that runs the
FMU, with steps of 2 ms. Pictures are counted in each second; late steps are told by what made them late. Only a machine
without other work shows what the program can do. Needs the extras ``simulator`` and ``pictures``.
"""

from __future__ import annotations

import itertools
import json
import statistics
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from ali3.running import run_command
from benchmarks.shared.command import parser_of, save_rows, watched
from benchmarks.shared.simulator_program import simulator
from benchmarks.shared.tables import print_table
from viewer import browser

SIZE, WORLD = (640, 360), "proving_ground"
SETTLING = 8  # s: programs and textures are made, the level is chosen
SPEED, CURVE = 15.0, 8  # m/s; s of a curve before one to the other side: the car stays among what the world has
COUNT = """() => {
  window.drawnAt = [];
  const draw = player.view.render.bind(player.view);
  player.view.render = () => { draw(); drawnAt.push(performance.now()); };
}"""
LIVE = "({ factor: player.factor, moved: player.session.pace.slow, cost: player.session.pace.cost })"


def pictures(page: Any, seconds: float) -> dict[str, float]:
    """Drive curves to the left and to the right by keys, and count.

    Result: `median`, `worst`: pictures in a second; `longest_ms`: between two pictures; `calls`, `triangles`: of the
    last.
    """
    for k in range(round(SETTLING + seconds)):
        if k == SETTLING:
            page.evaluate(COUNT)
        getattr(page.keyboard, "down" if page.evaluate("player.get('speed')") < SPEED else "up")("w")
        page.keyboard.up("da"[k // CURVE % 2])
        page.keyboard.down("ad"[k // CURVE % 2])
        page.wait_for_timeout(1e3)
    times = [1e-3 * t for t in page.evaluate("drawnAt")]
    cost = page.evaluate("(({ calls, triangles }) => ({ calls, triangles }))(player.view.renderer.info.render)")
    counts = [sum(k <= t - times[0] < k + 1 for t in times) for k in range(int(times[-1] - times[0]))]
    longest = 1e3 * max(b - a for a, b in itertools.pairwise(times))
    return {"median": statistics.median(counts), "worst": min(counts), "longest_ms": longest, **cost}


def in_simulator(chromium: Any, fmu: Path, folder: Path, seconds: float) -> dict[str, Any]:
    """Of the simulator; its late steps by cause."""
    report = folder / "report.json"
    with simulator(fmu, ["--world", WORLD, "--json", str(report)]) as address:
        page = _page(chromium)
        page.goto(address)
        page.wait_for_function("window.player?.frames?.newest?.running")
        found = pictures(page, seconds)
        page.close()
    steps = json.loads(report.read_text(encoding="utf-8"))["steps"]
    return {"page": "simulator", **found, "steps": steps["steps"], "late": steps["missed"], **steps["missed_by"]}


def in_tab(chromium: Any, fmu: Path, folder: Path, seconds: float) -> dict[str, Any]:
    """Of the page that runs the FMU: a step is late where the page had to move its schedule (by 0.1 s or more)."""
    view = [sys.executable, "-m", "ali3", "view", str(fmu), "--live", "--world", WORLD, "--no-open"]
    subprocess.run([*view, "--out", str(folder)], check=True, stdout=subprocess.DEVNULL)
    (file,) = folder.glob("*_live.html")
    page = _page(chromium)
    page.goto(file.as_uri())
    page.evaluate("async () => { await player.ready; }")
    found = pictures(page, seconds)
    pace = page.evaluate(LIVE)
    page.close()
    return {"page": "live page", **found, "late": pace["moved"], "factor": pace["factor"]}


def _page(chromium: Any) -> Any:
    width, height = SIZE
    page = chromium.new_page(viewport={"width": width, "height": height}, bypass_csp=True)  # it forbids waiting
    page.set_default_timeout(120_000)
    return page


PAGES: dict[str, Callable[[Any, Path, Path, float], dict[str, Any]]] = {"simulator": in_simulator, "live": in_tab}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = parser_of("driven_pages", __doc__)
    parser.add_argument("--seconds", type=float, default=60.0, metavar="S", help="of each page; default: 60")
    parser.add_argument("--only", nargs="+", choices=PAGES, default=list(PAGES), metavar="NAME", help="default: both")
    options = parser.parse_args(arguments)
    if not options.seconds >= 2.0:
        parser.error("--seconds is 2 or more")
    from playwright.sync_api import sync_playwright

    with TemporaryDirectory() as given, sync_playwright() as play:
        folder = Path(given)
        build = [sys.executable, "-m", "ali3", "build", "prototype", "--poses", "all", "--kind", "native"]
        build += ["--platforms", "this,wasm32", "--out", given]
        subprocess.run(build, check=True, stdout=subprocess.DEVNULL)
        (fmu,) = folder.glob("*.fmu")
        chromium = play.chromium.launch(executable_path=browser.find_chromium(), args=browser.launch_arguments())
        rows = [PAGES[name](chromium, fmu, folder, options.seconds) for name in watched(options.only)]
        version = chromium.version
        chromium.close()
    numbers = ("median", "worst", "longest_ms", "calls", "triangles", "steps", "late", "ran", "others", "stolen")
    columns = {"page": "", **dict.fromkeys(numbers, ".0f"), "factor": ".3f"}
    rows = [dict.fromkeys(columns) | row for row in rows]
    print_table(rows, columns)
    print(
        f"\n{SIZE[0]} x {SIZE[1]}, {options.seconds:g} s; median, worst: pictures in a second; ran, others, stolen: "
        "late steps while the step ran, other programs ran, the processor stood still\nChromium " + version
    )
    save_rows(options.json, "driven_pages", rows, chromium=version, size=SIZE, seconds=options.seconds)
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
