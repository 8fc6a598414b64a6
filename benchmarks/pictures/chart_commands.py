"""Draws charts of the pages again, each by the command that its page names."""

import contextlib
import re
import shlex
import shutil
import tempfile
from collections.abc import Callable
from contextlib import redirect_stdout
from functools import partial
from io import StringIO
from pathlib import Path

from ali3.chart_description import read_description
from ali3.charts import save_picture
from benchmarks.car.frame_pictures import draw_gauges
from benchmarks.shared.figures import RemadeTable
from benchmarks.shared.pages import DOCS
from hosts.compare.command import main as compare
from hosts.fmu.built_fmu import fmu_of_scene
from hosts.run.command import main as run
from mbs.vehicle import load
from mbs.vehicle.kinematics.car_kinematics import kinematics
from mbs.vehicle.kinematics.plots import travel_figure
from mbs.worlds.command import main as draw_world


def charts(_: bool) -> list[RemadeTable]:
    """All charts of `CHARTS`, drawn again."""
    results = []
    with tempfile.TemporaryDirectory() as folder:
        for name, draw in CHARTS.items():
            file = Path(folder, name)
            with redirect_stdout(StringIO()):
                draw(file)
            results.append(RemadeTable(f"docs/images/{name}", read_description(file), picture=file.read_bytes()))
    return results


def _prototype() -> Path:
    return fmu_of_scene("prototype_car", lambda words: None)


def _first_command(file: Path) -> None:
    """Draw the picture of README.md's first command."""
    out = file.with_suffix("")
    if run([str(_prototype()), "--manoeuvre", "double_lane_change", "--out", str(out)]):
        raise RuntimeError("The first command of README.md has refused steps.")
    (picture,) = out.glob("*.png")
    picture.rename(file)


def _frame(car: str, file: Path) -> None:
    draw_gauges(load(car), str(file))


def _fit(file: Path) -> None:
    """Draw the fit of docs/compare.md by the code and the command of the page."""
    page = (DOCS / "compare.md").read_text(encoding="utf-8")
    (code,) = re.findall(r"^```python\n(.*?)^```", page, re.MULTILINE | re.DOTALL)
    command = re.search(r"^    ali3 compare (dist/PrototypeCar.fmu (?:.*\\\n)*.*)", page, re.MULTILINE)
    assert command is not None
    folder = file.with_suffix("")
    (folder / "dist").mkdir(parents=True)
    shutil.copy(_prototype(), folder / "dist" / "PrototypeCar.fmu")
    with contextlib.chdir(folder):
        exec(code, {})
        if compare(shlex.split(command[1].replace("\\\n", ""))):
            raise RuntimeError("The fit of docs/compare.md is not good.")
    (folder / "out" / "compare" / "drive.svg").rename(file)


def _travel(file: Path) -> None:
    save_picture(travel_figure(kinematics(load("hatchback")), "front"), file)


def _map(file: Path) -> None:
    draw_world(["--world", "proving_ground", "--out", str(file.parent), "--picture", str(file)])


CHARTS: dict[str, Callable[[Path], None]] = {
    "double_lane_change.png": _first_command,
    "frame_gauges.png": partial(_frame, "prototype"),
    "compare.svg": _fit,
    "hatchback_frame.png": partial(_frame, "hatchback"),
    "kinematics_hatchback.png": _travel,
    "proving_ground.png": _map,
}
"""Functions that draw the charts within seconds, by file name in docs/images."""
