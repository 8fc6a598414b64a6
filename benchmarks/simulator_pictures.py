"""The simulator as it is driven: ``python -m benchmarks.simulator_pictures [--only NAME] [--out DIR]``.

Drives the prototype car through the pages of the simulator and takes their pictures with the instruments, whose rates
are those of this machine while it is driven: each is printed, with the deadlines missed. Only a machine without other
work shows what the program can do. Needs the extras ``simulator`` and ``pictures``.
"""

from __future__ import annotations

import io
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from ali3.files import whole_file
from ali3.running import run_command
from benchmarks.shared.command import parser_of, watched
from benchmarks.shared.simulator_program import simulator
from viewer import browser

SIZE = (800, 450)  # pixels: the smallest at which the bar is one line
NEWEST = "player.frames.newest"
RATES = f"({{ ...player.flow, missed: {NEWEST}.missed, worst: {NEWEST}.worst, time: {NEWEST}.time }})"


@dataclass(frozen=True)
class Shot:
    """A picture."""

    place: str
    """Where the car starts, of the proving ground."""
    held: tuple[tuple[str, float], ...]
    """Keys that are held together with the one for the throttle, one after the other, and for how long, s."""
    camera: str
    """Name of the view as the page's list has it."""
    fidelity: int = 0
    """Of the car's FMU, 0 rigid to 4."""
    acts: tuple[str, ...] = ()
    """Keys before the picture is taken."""


SHOTS = {
    "chase": Shot("start", (("", 14.0),), "chase"),
    "map": Shot("slalom", (("", 5.0), *((key, 0.7) for key in ("a", "d", "d", "a", "a", "d"))), "map"),
    "stress": Shot("kerbs", (("", 5.0),), "orbit", 2, ("f", "p")),
}


def drive(page: Any, shot: Shot) -> None:
    """Until the picture is to be taken."""
    page.wait_for_function(f"window.player?.{NEWEST.removeprefix('player.')}?.running")
    if wrong := page.evaluate("name => player.camera(name)", shot.camera):
        raise RuntimeError(wrong)
    page.keyboard.down("w")
    for key, seconds in shot.held:
        if key:
            page.keyboard.down(key)
        page.wait_for_timeout(1e3 * seconds)
        if key:
            page.keyboard.up(key)
    for key in shot.acts:
        page.keyboard.press(key)
    if shot.acts:
        page.wait_for_timeout(1500)


def take(fmu: Path, shot: Shot, file: Path) -> dict[str, float]:
    """Drive, write the picture, and give the rates that stand in it."""
    from PIL import Image
    from playwright.sync_api import sync_playwright

    options = ["--place", shot.place, "--fidelity", str(shot.fidelity)]
    with simulator(fmu, options) as address, sync_playwright() as play:
        chromium = play.chromium.launch(executable_path=browser.find_chromium(), args=browser.launch_arguments())
        width, height = SIZE
        page = chromium.new_page(viewport={"width": width, "height": height}, bypass_csp=True)  # it forbids waiting
        page.set_default_timeout(120_000)
        page.goto(address)
        drive(page, shot)
        picture, rates = page.screenshot(), page.evaluate(RATES)
        chromium.close()
    with whole_file(file) as made:
        Image.open(io.BytesIO(picture)).convert("RGB").save(made, "webp", quality=80, method=6)
    return dict(rates)


def main(arguments: Sequence[str] | None = None) -> int:
    """Drive, draw, say where."""
    parser = parser_of("simulator_pictures", __doc__, json=False)
    parser.add_argument("--only", nargs="+", choices=SHOTS, default=list(SHOTS), metavar="NAME", help="default: all")
    parser.add_argument("--out", type=Path, default=Path("out"), metavar="DIR", help="folder for results; default: out")
    options = parser.parse_args(arguments)
    options.out.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory() as folder:
        build = [sys.executable, "-m", "ali3", "build", "prototype", "--poses", "all", "--kind", "native"]
        subprocess.run([*build, "--out", folder], check=True, stdout=subprocess.DEVNULL)
        (fmu,) = Path(folder).glob("*.fmu")
        for name in watched(options.only):
            file = options.out / f"simulator_{name}.webp"
            n = take(fmu, SHOTS[name], file)
            print(
                f"{file}: at {n['time']:.1f} s {n['drawn']:.0f} pictures/s (longest {1e3 * n['longest']:.0f} ms), "
                f"{n['missed']:.0f} deadlines missed, the longest step {1e3 * n['worst']:.2f} ms"
            )
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
