"""Pictures of the simulator, driven through its page, with the instruments of this machine."""

import io
import re
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from ali3.files import atomic_file, make_folder
from benchmarks.shared.command import watched
from viewer import browser

SIZE = (960, 540)  # pixels: small, and no text is hidden by a legend
NEWEST = "player.frames.newest"
RATES = f"({{ ...player.flow, missed: {NEWEST}.missed, worst: {NEWEST}.worst, time: {NEWEST}.time }})"


@dataclass(frozen=True)
class Shot:
    """A picture of the simulator and the drive before it."""

    place: str
    """Start of the car in the proving ground."""
    pressed: tuple[tuple[str, float], ...]
    """Successive keys that are pressed in addition to the throttle, and their durations, s."""
    camera: str
    """Name of the view in the list of the page."""
    fidelity: int = 0
    """Fidelity of the car's FMU, 0 (rigid) to 4."""
    acts: tuple[str, ...] = ()
    """Keys that are pressed before the picture."""
    devices: tuple[Mapping[str, Any], ...] = ()
    """States of devices, as `Device.state` has them; with some the picture is that of their panel."""
    size: tuple[int, int] = SIZE
    hit: float = 0.0
    """Load of a front wheel at which the run is paused for the picture, N; 0: it is not."""


def _axis(number: int, value: float, dead_zone: float, **more: Any) -> dict[str, Any]:
    """The mapping of an input to an axis, with its value."""
    ends = {"low": -1.0, "high": 1.0, "inverted": True, "centre": None}
    return {"source": f"axis {number}", "dead_zone": dead_zone, "value": value} | ends | more


WHEEL = {
    **{"id": "wheel", "name": "Wheel", "kind": "wheel", "usb": [0, 0], "force": True, "force_problem": ""},
    **{"axes": [-0.4, 0.0, -0.2, 1.0], "buttons": [0, 0, 0, 1, 0, 1], "hats": [], "assigning": None},
    "inputs": ["steering", "throttle", "brake", "hand_brake", "selector drive", "selector neutral", "selector reverse"],
    "mapping": {"steering": _axis(0, 0.4, 0.0), "throttle": _axis(2, 0.6, 0.03), "brake": _axis(3, 0.0, 0.03)},
    "settings": {"rotation": 900, "force": 0.5, "full_torque": 10, "smoothing": 0.01, "damper": 0.1, "spring": 0.1},
    "calibration": None,
}
"""A steering wheel with two pedals; none is plugged in for the picture."""

SHOTS = {
    "chase": Shot("start", (("", 14.0),), "chase", acts=("k",)),
    "map": Shot("slalom", (("", 5.0), *((key, 0.7) for key in ("a", "d", "d", "a", "a", "d"))), "map"),
    "stress": Shot("kerbs", (), "orbit", 2, ("b", "f"), hit=4000.0),
    "devices": Shot("start", (), "chase", acts=("g",), devices=(WHEEL,), size=(1280, 1000)),
}


_PAUSE_WHEN_HIT = """(load) => new Promise((done) => {
  const { cockpit, frames } = player;
  const columns = ["wheel_FL.Fz", "wheel_FR.Fz"].map((name) => cockpit.source.index.get(name));
  const look = setInterval(() => {
    if (!columns.some((column) => frames.newest.values[column] > load)) return;
    clearInterval(look);
    cockpit.acts.toggle();
    done();
  }, 2);
})"""


@contextmanager
def simulator(fmu: Path, options: Sequence[str]) -> Iterator[str]:
    """Context of a running simulator; yields its address."""
    command = [sys.executable, "-m", "ali3", "simulator", str(fmu), "--no-open", "--no-devices", *options]
    host = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    output = ""
    try:
        for line in host.stdout or ():
            output += line
            if match := re.search(r"http://\S+", line):
                break
        else:
            raise RuntimeError(f"The simulator did not start: {output}")
        yield match[0]
    finally:
        host.terminate()
        host.communicate()


def drive(page: Any, shot: Shot) -> None:
    """Drive until the picture is taken."""
    page.wait_for_function("window.player?.frames?.newest?.running")
    if wrong := page.evaluate("name => player.camera(name)", shot.camera):
        raise RuntimeError(wrong)
    page.keyboard.down("w")
    for key, seconds in shot.pressed:
        if key:
            page.keyboard.down(key)
        page.wait_for_timeout(1e3 * seconds)
        if key:
            page.keyboard.up(key)
    for key in shot.acts:
        page.keyboard.press(key)
    if shot.hit:
        page.evaluate(_PAUSE_WHEN_HIT, shot.hit)
    page.wait_for_timeout(1500)
    if shot.hit:
        page.evaluate("player.cockpit.setLook({ quality: 'medium' })")  # whatever this machine draws while it drives
        page.wait_for_function("!document.querySelector('[data-a3=events] > *')")  # they fade


def take(fmu: Path, shot: Shot, file: Path) -> dict[str, float]:
    """Drive, write the picture, and return frame rates and times."""
    from PIL import Image
    from playwright.sync_api import sync_playwright

    options = ["--place", shot.place, "--fidelity", str(shot.fidelity)]
    with simulator(fmu, options) as address, sync_playwright() as play:
        chromium = play.chromium.launch(executable_path=browser.find_chromium(), args=browser.launch_arguments())
        width, height = shot.size
        page = chromium.new_page(viewport={"width": width, "height": height}, bypass_csp=True)  # it forbids waiting
        page.set_default_timeout(120_000)
        page.goto(address)
        drive(page, shot)
        if shot.devices:
            page.evaluate("devices => player.cockpit.devices(devices)", shot.devices)
        shown = page.locator("[data-a3='section Devices']") if shot.devices else page
        picture, rates = shown.screenshot(), page.evaluate(RATES)
        chromium.close()
    with atomic_file(file) as temporary:
        Image.open(io.BytesIO(picture)).convert("RGB").save(temporary, "webp", quality=80, method=6)
    return dict(rates)


def take_all(names: Sequence[str], folder: Path) -> None:
    """Build the car, write all pictures, and print their paths and frame rates."""
    make_folder(folder)
    with TemporaryDirectory() as built:
        build = [sys.executable, "-m", "ali3", "build", "prototype", "--kind", "native"]
        subprocess.run([*build, "--out", built], check=True, stdout=subprocess.DEVNULL)
        (fmu,) = Path(built).glob("*.fmu")
        for name in watched(names):
            file = folder / f"simulator_{name}.webp"
            n = take(fmu, SHOTS[name], file)
            print(
                f"{file}: at {n['time']:.1f} s {n['drawn']:.0f} pictures/s (longest {1e3 * n['longest']:.0f} ms), "
                f"{n['missed']:.0f} deadlines missed, the longest step {1e3 * n['worst']:.2f} ms"
            )
